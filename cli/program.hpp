#pragma once

namespace arris {

/// The whole program: reads the command line, runs the command, and turns what went wrong into one line on
/// stderr. Returns the exit code: 0 in tolerance, 1 a bug, 2 usage, 3 input or recipe, 4 out of tolerance, 5
/// refused, 6 device, 7 indeterminate, 130 interrupted.
[[nodiscard]] int run_program(int argc, const char* const* argv);

}  // namespace arris
