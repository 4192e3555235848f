#pragma once

#include <string>
#include <string_view>

#include "toolpath/robot/reading.hpp"

namespace arris {

/// Reads a file of V+ programs of moves and I/O, and runs it on paper: what the controller would do, in
/// order. Shares no code with the writer. Words of the language and names know no case. A statement a line;
/// comments from `;` to its end; blank lines anywhere.
///
///     file        = program { program }
///     program     = .PROGRAM name "()" { AUTO LOC name } { statement } .END
///     statement   = SELECT ROBOT "=" n | ATTACH "()" | DETACH "()" | REACTE name | TOOL name | CPON ALWAYS
///                 | SET name "=" ( trans | FRAME "(" name "," name "," name "," name ")" )
///                 | SPEED number [ "," number ] MMPS ALWAYS
///                 | ( MOVE | MOVES ) location | ( APPRO | APPROS ) location "," number
///                 | ( DEPART | DEPARTS ) number | BREAK
///                 | SIGNAL [ "-" ] n | TIMER n "=" 0 | WAIT state [ OR "(" TIMER "(" n ")" ">" number ")" ]
///                 | IF NOT state THEN { statement } END | TYPE string | HALT | CALL name "()"
///     state       = SIG "(" [ "-" ] n ")"
///     location    = [ name ":" ] ( name | trans )
///     trans       = TRANS "(" number { "," number } ")"       x, y, z, yaw, pitch, roll
///     number      = [ "-" ] digits [ "." digits ]              no exponent, no minus zero
///
/// APPRO and APPROS go to the location moved back by the number, mm, along its own z; DEPART and DEPARTS so
/// from the pose of the last move, in its frame.
///
///   returns  the moves, signals and waits in the order of execution, calls followed, locations resolved;
///            signals are named by their numbers; a move that a BREAK follows has zone 0, any other none
///   throws   Error(kInput) with line and reason: a text outside the grammar; a line of more than 128
///            characters; a name of more than 15, or declared twice; a location that the program does not
///            set; a move without SPEED before; a DEPART before any move with its tool; a DEPART, SIGNAL,
///            wait, DETACH, HALT or the end while the robot moves; a wait with a time whose TIMER is not set
///            to 0 before, or that is not looked at behind; a frame or tool that changes; a program that
///            calls itself or is never called
[[nodiscard]] Reading read_vplus(std::string_view text, const std::string& source);

}  // namespace arris
