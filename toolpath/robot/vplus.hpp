#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "toolpath/robot/program.hpp"

namespace arris {

/// V+ programs for Adept and Omron controllers, one file: the program that is executed, then its parts and
/// its error trap.
///   head        comments under the first .PROGRAM: what was given, result_hash, body_sha256 (sha256_hex of
///               the whole text without the digits of body_sha256 itself)
///   poses       SET p = TRANS(x, y, z, yaw, pitch, roll), then MOVE or MOVES work:p, one point after
///   another;
///               mm and degrees 4 decimals, fixed notation, no -0; no line longer than 120 characters
///   frames      tool and work by SET .. = TRANS(..), or FRAME(a, b, c, a) of points that are taught on the
///               controller (cell.work_points), or as the controller has them
///   speeds      SPEED n, percent MMPS ALWAYS wherever the speed changes, and first in every program
///   stops       BREAK behind a move with zone 0; V+ has no zones, so every other move is passed on its
///               continuous path, as near as the controller's acceleration lets it
///   outputs     SIGNAL by number, behind a BREAK alone, for V+ runs on while the robot moves; the wait for
///               an input ends by a TIMER. An input that is late, and any error (REACTE), switches the
///               tool's output off and HALTs
///   length      more than cell.max_points moves: programs <name>.1, <name>.2, ... called by the first
///   throws      Error(kRecipe): a name that V+ cannot have or that the program uses itself, an output or
///               input that is no signal number, work_points that are not three names, a speed that rounds to
///               0; Error(kBug): a pose that is not finite, an output or a wait behind a move that does not
///               stop, an end while the robot moves
[[nodiscard]] std::string write_vplus(const Program& program,
                                      const std::function<std::string(std::string_view)>& sha256_hex);

}  // namespace arris
