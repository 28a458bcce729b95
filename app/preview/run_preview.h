// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/preview_subject.h"

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

}  // namespace sheen::app
