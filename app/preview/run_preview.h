// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/preview_subject.h"
#include "app/preview/walk_subject.h"

#include <functional>

namespace sheen::app {

/// Throws core::Error (run_failed) where there is no display, or this build has no windows.
void check_display();

/// Shows a finished light field until the window is closed.
void run_viewer(const PreviewSubject& subject);

/// Runs `work`, which drives the subject's live session, on a thread of its own while the window is
/// on the calling one, the main thread. Returns when the work has ended and the window is closed;
/// closing it early lets the work go on without it, after `on_closed` (may be empty) was called.
/// Somebody who interrupts the program to finish early has the window closed when the work is done.
/// Exceptions of the work come out here, at once.
void run_preview(const PreviewSubject& subject, const std::function<void()>& work,
                 const std::function<void()>& on_closed);

/// Shows a walk while `work`, on a thread of its own, lets the subject's walk look at its frames.
/// Returns when the work has ended; the window is closed then, or earlier by somebody who has
/// finished, which `on_closed` hears. Exceptions of the work come out here.
void run_walk(const WalkSubject& subject, const std::function<void()>& work,
              const std::function<void()>& on_closed);

}  // namespace sheen::app
