#pragma once

#include <string>
#include <vector>

#include "tests/bench/accuracy/case.hpp"

namespace arris::bench {

/// One run: what the clock on the wall says, and what all cores together worked.
struct Spent {
  double wall_ms = 0.0, cpu_ms = 0.0;
};

/// Times of one stage over the rounds.
struct Times {
  std::string stage;
  std::vector<Spent> rounds;
  [[nodiscard]] double median_ms() const;      ///< wall
  [[nodiscard]] double least_ms() const;       ///< wall
  [[nodiscard]] double cpu_median_ms() const;  ///< hardly moved by what else the machine does
};

/// One part's times, all measured in turn in each round.
struct PartTimes {
  std::string part;
  std::size_t points = 0;
  Times total,
      with_cad;  ///< points in memory -> corrected path; the same with the CAD prepared from its mesh
  std::vector<Times> stages;  ///< of the total, each run by itself on the same data
  std::vector<Times> peers;   ///< PCL's ICPs, given the start pose
};

/// Rounds beyond a warm-up of two.
[[nodiscard]] PartTimes measure_times(const BenchPart& part, int rounds);

/// Total, goal and peers; then the stages.
[[nodiscard]] std::string times_table(const std::vector<PartTimes>& parts, int rounds, int threads);

}  // namespace arris::bench
