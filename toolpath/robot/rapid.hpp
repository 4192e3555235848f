#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "toolpath/robot/program.hpp"

namespace arris {

/// An ABB RAPID module (RobotWare 6 and 7): tool, work object, speeds, zones, targets, then the entry
/// procedure.
///   head      comments under the MODULE line: what was given, result_hash, body_sha256
///   body_sha256   sha256_hex of the whole text without the digits of body_sha256 itself
///   outputs   behind moves with zone `fine` alone, so that the program pointer cannot run ahead of the tool;
///   a tool
///             that is not ready in time, and any error, switches the tool output off
///   axes      ConfJ\Off, ConfL\Off and configuration [0,0,0,0]: no kinematic model here decides them (header
///   says so) numbers   mm 4 decimals, quaternion 8 decimals (normalised, rounded, normalised), fixed
///   notation, no -0 length    more than cell.max_points moves: procedures part1, part2, ... called by the
///   entry procedure throws    Error(kRecipe): a name that RAPID reserves, that is no RAPID name, or that the
///   module uses itself; a
///             speed that rounds to 0; Error(kBug): a pose that is not finite
[[nodiscard]] std::string write_rapid(const Program& program,
                                      const std::function<std::string(std::string_view)>& sha256_hex);

}  // namespace arris
