// SPDX-License-Identifier: MIT
#include "core/concurrency/bounded_queue.h"
#include "core/concurrency/parallel_for.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
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
  EXPECT_FALSE(queue.try_pop());
  EXPECT_TRUE(queue.push(1));
  EXPECT_TRUE(queue.push(2));
  queue.close();
  EXPECT_TRUE(queue.is_closed());
  EXPECT_FALSE(queue.push(3));
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.try_pop(), 2);
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
