#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/drawing.hpp"
#include "cli/measurement.hpp"
#include "cli/recipe.hpp"
#include "report/run_record.hpp"

namespace arris {

/// What registration and correction made of a scan, with the field's numbers for the result hash.
struct Processed {
  RunRecord record;
  std::vector<double> field_parameters;
};

/// Called at the beginning of each stage: "aligning", "correcting", ..; the place where Ctrl-C is heard.
using StageHook = std::function<void(const std::string& stage)>;

/// Registration, correction, deviation and the three results, from data in memory. A run that cannot be
/// trusted comes back with record.refusals filled.
///   throws  Error(kInput): the scan is mirrored or in another unit, the path belongs nowhere on the CAD
[[nodiscard]] Processed process(const Recipe& recipe, const Drawing& drawing, Measurement& measurement,
                                bool inspect_only, int threads, const StageHook& stage);

}  // namespace arris
