#pragma once

#include <string>

#include "report/run_record.hpp"

namespace arris::report {

/// result.json: everything a run found, as data (schema "arris.result/1").
/// Keys in a fixed order, numbers rounded to 1e-6, what is not known (NaN) is null, LF at the end; no time of
/// day and no duration but record.report_time, so that equal runs give equal bytes. Text that is no UTF-8 is
/// mended.
[[nodiscard]] std::string write_json(const RunRecord& record);

}  // namespace arris::report
