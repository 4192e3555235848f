#pragma once

#include <string>
#include <vector>

#include "tests/arch/source_text.hpp"

namespace arris::arch {

/// A line that breaks a rule of the house.
struct Offence {
  std::string path;
  int line = 0;
  std::string what;
};

/// "path:line: what", one a line: what the test prints.
[[nodiscard]] std::string to_text(const std::vector<Offence>& offences);

/// The room of a path: the first folder, and in acquisition also types, geometry and bridge; empty outside
/// the rooms.
[[nodiscard]] std::string room_of(const std::string& path);

/// Our own includes name the path from the root (helpers of a test folder apart), and stay behind the doors:
/// data walks acquisition -> registration
/// -> toolpath -> report; fixtures see types only; the PCL bridge is for .cpp files.
[[nodiscard]] std::vector<Offence> check_doors(const SourceFile& file);

/// No third-party library in a header, but in the bridge's.
[[nodiscard]] std::vector<Offence> check_quarantine(const SourceFile& file);

/// Nothing prints or exits outside cli/ and the mains of tests, benches and fixtures.
[[nodiscard]] std::vector<Offence> check_silence(const SourceFile& file);

/// No file over 500 lines.
[[nodiscard]] std::vector<Offence> check_length(const SourceFile& file);

/// A double in a struct named ..Options ends in its unit, or in _ratio or _sigmas.
[[nodiscard]] std::vector<Offence> check_units(const SourceFile& file);

}  // namespace arris::arch
