#pragma once

namespace arris {

/// Reads the command line and runs the command that it names; returns the command's exit code.
///   throws  Error(kUsage) for a command line that cannot be understood; what the command throws
[[nodiscard]] int run_command_line(int argc, const char* const* argv);

}  // namespace arris
