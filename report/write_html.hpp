#pragma once

#include <string>

#include "report/run_record.hpp"

namespace arris::report {

/// report.html: one page for people that works offline (pictures, style and script inside, nothing fetched),
/// prints on A4, and has for a refused run the reasons in the place of the path. Every text from outside is
/// escaped. Equal runs give equal bytes.
[[nodiscard]] std::string write_html(const RunRecord& record);

}  // namespace arris::report
