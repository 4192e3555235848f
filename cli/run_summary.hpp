#pragma once

#include <filesystem>

#include "report/run_record.hpp"

namespace arris {

/// The outcome on stdout: verdicts in words, the numbers that decide, where the files are; one object with
/// json.
void print_summary(const RunRecord& record, const std::filesystem::path& folder, double total_s, bool json);

}  // namespace arris
