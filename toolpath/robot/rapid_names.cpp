#include "toolpath/robot/rapid_names.hpp"

#include "acquisition/types/error.hpp"
#include "toolpath/robot/names.hpp"

namespace arris {
namespace {

// The reserved words of RAPID, and the types and instructions that the module uses.
const std::set<std::string> kReserved = {
    "alias",     "and",     "backward", "case",     "connect",   "const",     "default",   "div",
    "do",        "else",    "elseif",   "endfor",   "endfunc",   "endif",     "endmodule", "endproc",
    "endrecord", "endtest", "endtrap",  "endwhile", "error",     "exit",      "false",     "for",
    "from",      "func",    "goto",     "if",       "inout",     "local",     "mod",       "module",
    "nostepin",  "not",     "noview",   "or",       "pers",      "proc",      "raise",     "readonly",
    "record",    "retry",   "return",   "step",     "sysmodule", "test",      "then",      "to",
    "task",      "trap",    "true",     "trynext",  "undo",      "var",       "viewonly",  "while",
    "with",      "xor",     "tooldata", "wobjdata", "speeddata", "zonedata",  "robtarget", "bool",
    "num",       "string",  "movej",    "movel",    "setdo",     "waitdi",    "confj",     "confl",
    "tpwrite",   "fine",    "offs",     "tool0",    "wobj0",     "breadylate"};

const NameRules kRapid = {.language = "RAPID",
                          .signs = "_",
                          .in_words = "letters, digits and underscores",
                          .longest = 32,
                          .reserved = kReserved,
                          .numbered = {"p", "vpath", "zpath", "part"},  // targets, speeds, zones, procedures
                          .predefined = {"tool0", "wobj0"}};

}  // namespace

void check_rapid_names(const Program& program) {
  const Cell& cell = program.cell;
  NameCheck names(kRapid);
  names.take("program_name", program.name);
  names.take("entry_name", cell.entry_name);
  names.take("tool_name", cell.tool_name, !cell.define_tool);
  names.take("work_name", cell.work_name, !cell.define_work);
  if (!cell.spindle_output.empty()) names.take("spindle_output", cell.spindle_output);
  if (!cell.spindle_ready.empty()) names.take("spindle_ready", cell.spindle_ready);
  if (!cell.work_points.empty())
    throw Error(Fault::kRecipe,
                "cell.work_points = \"" + cell.work_points + "\", need \"\" for RAPID: robot_from_work");
}

}  // namespace arris
