#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/run_log.hpp"
#include "report/run_record.hpp"
#include "toolpath/robot/cell.hpp"
#include "toolpath/robot/orientation.hpp"

namespace arris {

/// A file of the run folder: its name and bytes.
using NamedBytes = std::pair<std::string, std::string>;

/// The robot programs of an accepted correction in the language of a controller (robot.controller): the
/// program and its dry-run twin, each read back by the recogniser and compared with what was meant before it
/// is handed out. Throws Error(kBug) when they differ.
[[nodiscard]] std::vector<NamedBytes> robot_programs(const RunRecord& record, const Cell& cell,
                                                     const std::string& controller, Spin spin);

/// Every result file of a run, in memory; corrected.csv and programs only when the record is accepted.
[[nodiscard]] std::vector<NamedBytes> result_files(const RunRecord& record);

}  // namespace arris
