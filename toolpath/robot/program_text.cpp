#include "toolpath/robot/program_text.hpp"

#include <algorithm>

#include "acquisition/types/error.hpp"
#include "toolpath/formats/number.hpp"

namespace arris {

using std::string;

string ascii_text(string text) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = (c == '\t' || c == '\n' || c == '\r') ? ' ' : '?';
  return text;
}

string head_text(const Program& program, const string& lead, const string& note, std::size_t longest) {
  std::vector<string> comments = program.comments;
  if (program.dry_run)
    comments.push_back("DRY RUN: " + fixed_text(program.cell.dry_run_offset_mm, 1) +
                       " mm off along the tool axis, speeds times " +
                       fixed_text(program.cell.dry_run_speed_ratio, 2) + ", no output is switched.");
  comments.push_back(note);
  string text;
  for (const string& comment : comments) text += (lead + ascii_text(comment)).substr(0, longest) + "\n";
  return text + lead + "result_hash = " + ascii_text(program.result_hash) + "\n" + lead + "body_sha256 = ";
}

string speed_text(double speed_mm_s) {
  const string speed = fixed_text(speed_mm_s, 3);
  if (speed.find_first_not_of("0.") == string::npos)
    throw Error(Fault::kRecipe,
                "a speed of " + std::to_string(speed_mm_s) + " mm/s, need at least 0.001 mm/s");
  return speed;
}

std::vector<string> switched_outputs(const Program& program) {
  std::vector<string> outputs;
  for (const Event& event : program.events)
    if (const auto* set = std::get_if<SetOutput>(&event))
      if (std::find(outputs.begin(), outputs.end(), set->output) == outputs.end())
        outputs.push_back(set->output);
  return outputs;
}

bool switches_outputs(const Program& program) {
  return !switched_outputs(program).empty();
}

}  // namespace arris
