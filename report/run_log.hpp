#pragma once

#include <string>
#include <utility>
#include <vector>

namespace arris::report {

/// What differs between two runs of the same thing, and therefore stands in run.json alone.
struct RunTimes {
  std::string run_id;
  std::string started, finished;                        ///< ISO 8601, UTC
  std::vector<std::pair<std::string, double>> stage_s;  ///< stage and wall seconds, in order
  double total_s = 0.0;
  int threads = 0;
  std::string command_line;
};

/// One line of log.jsonl.
struct LogEntry {
  std::string time;            ///< ISO 8601, UTC
  double elapsed_s = 0.0;      ///< since the start
  std::string level = "info";  ///< info | warning | error
  std::string stage;
  std::string text;
};

/// run.json: times and timings of one run, with the result_hash that ties it to its result.json.
[[nodiscard]] std::string write_run_json(const RunTimes& times, const std::string& result_hash);

/// log.jsonl: one JSON object a line, in order; text that is no UTF-8 is mended, not refused.
[[nodiscard]] std::string write_log_jsonl(const std::vector<LogEntry>& entries);

}  // namespace arris::report
