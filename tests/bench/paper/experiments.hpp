#pragma once

#include <string>

#include "tests/bench/paper/tally.hpp"

namespace arris::bench {

// The experiments of the paper with our parts, each as a section of docs/experiments.md: what was done, the
// table and what it shows.

[[nodiscard]] std::string porthole_section(const BenchPart& porthole, int seeds);
[[nodiscard]] std::string nosecone_section(const BenchPart& nosecone, int seeds);
/// Cut as clamped, then released.
[[nodiscard]] std::string release_section(const BenchPart& part, int seeds);
[[nodiscard]] std::string density_section(const BenchPart& part, int seeds, bool quick);
[[nodiscard]] std::string stability_section(const BenchPart& part, int seeds);
[[nodiscard]] std::string overlap_section(const BenchPart& part, int seeds);

/// The nose cone's scans by name: as the tables and figures 7 and 10 use them.
struct NamedScan {
  std::string name;
  synthetic::ScanOptions options;
};
[[nodiscard]] std::vector<NamedScan> nosecone_scans();

}  // namespace arris::bench
