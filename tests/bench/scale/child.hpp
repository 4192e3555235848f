#pragma once

#include <string>
#include <vector>

namespace arris::bench {

/// A program that was run to its end.
struct Child {
  int code = -1;
  std::string out;  ///< its stdout and stderr
  double wall_s = 0.0, cpu_s = 0.0;
  double peak_mb = 0.0;       ///< largest resident memory, mapped files included; 1e6 bytes
  double anonymous_mb = 0.0;  ///< of it beyond all mapped files, looked at every few milliseconds
};

/// Runs words[0] with the others; looked for in PATH. Code 127 when there is no such program.
[[nodiscard]] Child run_child(const std::vector<std::string>& words);

}  // namespace arris::bench
