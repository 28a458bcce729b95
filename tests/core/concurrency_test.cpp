// SPDX-License-Identifier: MIT
#include "core/concurrency/bounded_queue.h"
#include "core/concurrency/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace sheen::core {
namespace {

TEST(ParallelFor, EqualsInlineForAnyNumberOfThreads) {
  for (const std::size_t count : {0u, 1u, 255u, 256u, 1000u, 4099u}) {
    std::vector<double> expected(count);
    for (std::size_t i = 0; i < count; ++i) expected[i] = std::sin(static_cast<double>(i));
    for (int threads = -1; threads <= 8; ++threads) {
      std::vector<double> values(count, -7);
      std::vector<int> visits(count, 0);
      parallel_for(count, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          values[i] = std::sin(static_cast<double>(i));
          ++visits[i];
        }
      });
      EXPECT_EQ(values, expected);
      EXPECT_EQ(visits, std::vector<int>(count, 1));
    }
  }
}

TEST(ParallelFor, PassesExceptionsOn) {
  for (int threads = 1; threads <= 8; ++threads) {
    EXPECT_THROW(parallel_for(5000, threads,
                              [](std::size_t, std::size_t end) {
                                if (end == 5000) throw std::domain_error("the last range");
                              }),
                 std::domain_error);
  }
}

/// Sum of 0 ... count - 1 by an inner loop on `threads` threads.
std::size_t sum_below(std::size_t count, int threads) {
  std::vector<std::size_t> values(count);
  parallel_for(count, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) values[i] = i;
  });
  return std::accumulate(values.begin(), values.end(), std::size_t{0});
}

TEST(ParallelFor, MayBeNested) {
  std::vector<std::size_t> sums(1024);
  parallel_for(sums.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sums[i] = sum_below(1000, 3);
  });
  // 0 + 1 + ... + 999 = 1000 * 999 / 2.
  EXPECT_EQ(sums, std::vector<std::size_t>(1024, 499500));
}

TEST(ParallelFor, ServesSeveralCallersAtOnce) {
  std::vector<std::size_t> wrong(4, 0);
  {
    std::vector<std::jthread> callers;
    for (std::size_t caller = 0; caller < wrong.size(); ++caller) {
      callers.emplace_back([&wrong, caller] {
        for (int repeat = 0; repeat < 300; ++repeat) {
          if (sum_below(1000, 2 + repeat % 3) != 499500) ++wrong[caller];
        }
      });
    }
  }
  EXPECT_EQ(wrong, std::vector<std::size_t>(4, 0));
}

/// Where threads meet: nobody goes on until all are there.
class Meeting {
 public:
  explicit Meeting(int members) : missing_(members) {}

  /// Waits for the others; false when they do not come, which a test must not wait for endlessly.
  bool attend() {
    constexpr std::chrono::minutes patience(2);
    std::unique_lock lock(mutex_);
    if (--missing_ == 0) complete_.notify_all();
    return complete_.wait_for(lock, patience, [this] { return missing_ == 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable complete_;
  int missing_;
};

/// One range for each of `threads` threads, under way at the same time: whoever took two of them
/// would wait for itself. Returns whether all met.
bool ranges_meet(int threads, const std::function<void()>& on_thread) {
  Meeting meeting(threads);
  std::atomic<int> met = 0;
  parallel_for(
      static_cast<std::size_t>(threads), threads,
      [&](std::size_t begin, std::size_t end) {
        on_thread();
        if (end - begin == 1 && meeting.attend()) ++met;
      },
      1);
  return met == threads;
}

TEST(ParallelFor, WorksOnAsManyThreadsAsItIsGiven) {
  for (int threads = 2; threads <= 8; ++threads)
    EXPECT_TRUE(ranges_meet(threads, [] {})) << threads;
}

std::atomic<int> threads_met = 0;
struct CountsItsThread {
  CountsItsThread() { ++threads_met; }
};

TEST(ParallelFor, KeepsItsThreads) {
  // An object of every thread that ever takes part. Every call has eight at once: the caller and
  // the same seven workers each time, since no call of this program asks for more.
  for (int repeat = 0; repeat < 100; ++repeat) {
    ASSERT_TRUE(
        ranges_meet(8, [] { [[maybe_unused]] thread_local const CountsItsThread counted; }));
  }
  EXPECT_EQ(threads_met, 8);
}

TEST(BoundedQueue, KeepsOrderAndLosesNothing) {
  constexpr int count = 20000;
  BoundedQueue<std::unique_ptr<int>> queue(3);
  std::jthread producer([&queue] {
    for (int i = 0; i < count; ++i) {
      if (!queue.push(std::make_unique<int>(i))) return;
    }
    queue.close();
  });
  int expected = 0;
  while (const auto item = queue.pop()) EXPECT_EQ(**item, expected++);
  EXPECT_EQ(expected, count);
}

TEST(BoundedQueue, ClosedStillGivesWhatItHolds) {
  BoundedQueue<int> queue(2);
  EXPECT_TRUE(queue.push(1));
  EXPECT_TRUE(queue.push(2));
  queue.close();
  EXPECT_FALSE(queue.push(3));
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(BoundedQueue, CloseFreesAProducerThatWaits) {
  BoundedQueue<int> queue(1);
  ASSERT_TRUE(queue.push(0));
  bool accepted = true;
  {
    // Whether the push waits already or only begins to, the closed queue refuses it.
    std::jthread producer([&] { accepted = queue.push(1); });
    queue.close();
  }
  EXPECT_FALSE(accepted);
}

TEST(BoundedQueue, CloseFreesAConsumerThatWaits) {
  BoundedQueue<int> queue(1);
  std::optional<int> item = 5;
  {
    std::jthread consumer([&] { item = queue.pop(); });
    queue.close();
  }
  EXPECT_FALSE(item);
}

}  // namespace
}  // namespace sheen::core
