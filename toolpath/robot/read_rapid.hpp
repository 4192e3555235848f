#pragma once

#include <string>
#include <string_view>

#include "toolpath/robot/reading.hpp"

namespace arris {

/// Reads a RAPID module of moves and I/O, and runs it on paper: what the controller would do, in order.
/// Shares no code with the writer. Words of the language and names know no case. Comments from `!` to the end
/// of the line.
///
///     module      = MODULE name { declaration } { procedure } ENDMODULE
///     declaration = ( CONST | PERS | VAR ) type name [ ":=" value ] ";"
///     type        = tooldata | wobjdata | speeddata | zonedata | robtarget | bool
///     value       = number | 9E9 | string | TRUE | FALSE | "[" value { "," value } "]"
///     number      = [ "-" ] digits [ "." digits ]              no exponent, no minus zero
///     procedure   = PROC name "(" ")" { statement } [ ERROR { statement } ] ENDPROC
///     statement   = ( ConfJ | ConfL ) "\" ( On | Off ) ";"
///                 | ( MoveJ | MoveL ) target "," name "," name "," name [ "\" WObj ":=" name ] ";"
///                 | SetDO name "," ( 0 | 1 ) ";"
///                 | WaitDI name "," ( 0 | 1 ) [ "\" MaxTime ":=" number ] [ "\" TimeFlag ":=" name ] ";"
///                 | IF name THEN { statement } ENDIF
///                 | TPWrite string ";" | EXIT ";" | RAISE ";" | name ";"
///     target      = name | Offs "(" name "," number "," number "," number ")" | value
///
///   returns  the moves, outputs and waits in the order of execution, procedures followed, targets resolved
///   throws   Error(kInput) with line and reason: a text outside the grammar; a name that is not declared,
///   declared twice
///            or longer than 32 characters; data of the wrong shape; a quaternion off length 1 by 1e-6;
///            external axes that are used; an IF that does not follow its WaitDI; a procedure that calls
///            itself or is never called
[[nodiscard]] Reading read_rapid(std::string_view text, const std::string& source);

}  // namespace arris
