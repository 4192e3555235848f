#pragma once

#include "report/run_record.hpp"

namespace arris::test {

/// A made-up run: a plate of 320 x 220 mm with a round hole, bent by about 9 mm, scanned with noise, a
/// missing patch, stray points and an offset of ten metres; its alignment, corrected path and errors are
/// invented, not computed.
[[nodiscard]] RunRecord sample_record();

/// The same, refused: a path over its limit, no program.
[[nodiscard]] RunRecord refused_record();

/// The first with a cell of four fixture targets: one of them not found; refused: one of them over its limit.
[[nodiscard]] RunRecord targets_record(bool refused);

/// A refusal before anything was aligned: a scan, no deviations, no path.
[[nodiscard]] RunRecord barely_started_record();

}  // namespace arris::test
