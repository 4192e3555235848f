#pragma once

#include <span>
#include <string>

#include "report/run_record.hpp"

namespace arris::report {

/// The text whose SHA-256 is the result_hash; the caller hashes it (and stores it in record.result_hash).
///   holds     role and hash of each input, sorted by role (file names play no part), version, scan_from_cad
///   row by
///             row, method, and the field's parameters; numbers as fixed decimals of 1e-6, one a line, LF
[[nodiscard]] std::string canonical_text(const RunRecord& record, std::span<const double> field_parameters);

}  // namespace arris::report
