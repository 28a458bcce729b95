// SPDX-License-Identifier: MIT
#pragma once

#include "app/pipeline/producer.h"

#include <functional>

namespace sheen::app {

/// Runs the producer to the end of its recording, on a thread of its own or, sequentially, on the
/// calling one; both give the same model. `on_frame` is called on the calling thread for every
/// frame, in order. A recorded frame is never dropped: when the watcher is slow, the producer
/// waits. Exceptions of the producer and Interrupted come out here.
void run_pipeline(Producer& producer, bool threaded,
                  const std::function<void(const FrameReport&)>& on_frame);

}  // namespace sheen::app
