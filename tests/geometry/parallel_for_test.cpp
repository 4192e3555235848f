#include "acquisition/geometry/parallel_for.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <atomic>
#include <bit>
#include <stdexcept>

#include "acquisition/types/error.hpp"
#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

TEST(ParallelFor, VisitsEachIndexOnce) {
  for (const std::size_t count : {0U, 1U, 7U, 8U, 9U, 1000U})
    for (const std::size_t chunk : {1U, 8U, 5000U})
      for (const int threads : {0, 1, 2, 8}) {
        std::vector<int> visits(count, 0);
        parallel_for(count, chunk, threads, [&](std::size_t begin, std::size_t end) {
          EXPECT_EQ(begin % chunk, 0U);
          EXPECT_TRUE(end - begin == chunk || end == count);
          for (std::size_t i = begin; i < end; ++i) ++visits[i];
        });
        EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), static_cast<std::ptrdiff_t>(count));
      }
}

TEST(ParallelFor, SumsToTheSameBitsForAnyThreadCount) {
  testing::Random random(1);
  std::vector<double> terms;
  for (int i = 0; i < 100000; ++i)
    terms.push_back(random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-8, 8)));
  const auto sum_with = [&](int threads) {
    return parallel_sum(terms.size(), 777, threads, 0.0, [&](std::size_t begin, std::size_t end) {
      double part = 0.0;
      for (std::size_t i = begin; i < end; ++i) part += terms[i];
      return part;
    });
  };
  const auto bits = std::bit_cast<std::uint64_t>(sum_with(1));
  for (const int threads : {0, 2, 3, 8, 64})
    for (int again = 0; again < 10; ++again) EXPECT_EQ(std::bit_cast<std::uint64_t>(sum_with(threads)), bits);
}

TEST(ParallelFor, SumsMatrices) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d sum = parallel_sum(100, 7, 2, zero, [](std::size_t begin, std::size_t end) {
    return Eigen::Vector3d::Constant(static_cast<double>(end - begin)).eval();
  });
  EXPECT_EQ(sum, Eigen::Vector3d::Constant(100.0));
  EXPECT_EQ(parallel_sum(0, 7, 2, zero, [&](std::size_t, std::size_t) { return zero; }), zero);
}

TEST(ParallelFor, ThrowsTheLowestChunksExceptionAfterTheRest) {
  for (const int threads : {1, 2, 8}) {
    std::atomic<int> ran{0};
    try {
      parallel_for(100, 10, threads, [&](std::size_t begin, std::size_t) {
        ++ran;
        if (begin >= 30) throw std::runtime_error(std::to_string(begin));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "30");
    }
    EXPECT_EQ(ran.load(), 10);
  }
}

TEST(ParallelFor, MayBeNested) {
  std::vector<int> visits(64 * 64, 0);
  parallel_for(64, 1, 8, [&](std::size_t outer, std::size_t) {
    parallel_for(64, 4, 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t inner = begin; inner < end; ++inner) ++visits[outer * 64 + inner];
    });
  });
  EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), 64 * 64);
}

TEST(ParallelFor, PassesAnInnerExceptionOut) {
  EXPECT_THROW(parallel_for(8, 1, 4,
                            [](std::size_t, std::size_t) {
                              parallel_for(8, 1, 4, [](std::size_t begin, std::size_t) {
                                if (begin == 5) throw Error(Fault::kInput, "inner");
                              });
                            }),
               Error);
}

TEST(ParallelFor, RefusesChunksOfNothing) {
  EXPECT_THROW(parallel_for(8, 0, 1, [](std::size_t, std::size_t) {}), Error);
  EXPECT_THROW((void)parallel_sum(8, 0, 1, 0.0, [](std::size_t, std::size_t) { return 1.0; }), Error);
}

}  // namespace
}  // namespace arris
