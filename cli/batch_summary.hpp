#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/batch_rows.hpp"

namespace arris {

/// A finished batch, rows in the order in which the scans were given.
struct BatchRecord {
  std::string part_number;
  std::filesystem::path recipe, folder;
  std::vector<BatchRow> rows;
  double total_s = 0.0;
};

/// How far a batch is.
struct BatchProgress {
  std::size_t done = 0, total = 0;  ///< scans, those kept from before among them
  std::size_t not_good = 0;         ///< of those that are done: every exit code but 0
  std::optional<double> left_s;     ///< estimated; unknown before the first one is done
  std::vector<std::string> running;
};

/// "12/1000 scans, 1 not good, 3 min left; running part7, part9"
[[nodiscard]] std::string progress_text(const BatchProgress& progress);

/// summary.csv: a row a scan. Holds nothing that depends on when, how fast, in what order or in how many
/// attempts the scans were run; lengths in mm, unknown figures empty, CRLF-free, quoted as RFC 4180 says.
[[nodiscard]] std::string summary_csv(std::span<const BatchRow> rows);

/// times.csv: what summary.csv leaves out: kept or run, why again, seconds.
[[nodiscard]] std::string times_csv(std::span<const BatchRow> rows);

/// The whole batch as one JSON object, schema arris.batch/1.
[[nodiscard]] std::string batch_json(const BatchRecord& record);

/// The outcome for people, on stdout: counts, the worst by name, what to do next, where the table is.
void print_batch(const BatchRecord& record);

}  // namespace arris
