#include "toolpath/robot/vplus.hpp"

#include "acquisition/types/error.hpp"
#include "toolpath/formats/number.hpp"
#include "toolpath/robot/program_text.hpp"
#include "toolpath/robot/vplus_location.hpp"
#include "toolpath/robot/vplus_names.hpp"

namespace arris {
namespace {

using std::string;

constexpr std::size_t kLongestLine = 120;
const string kIndent = "        ";

class Writer {
 public:
  explicit Writer(const Program& program) : program_(program), cell_(program.cell) {}

  string run(const std::function<string(std::string_view)>& sha256_hex) {
    for (; at_ < program_.events.size(); ++at_)
      std::visit([&](const auto& event) { take(event); }, program_.events[at_]);
    must_stand("the end of the program");
    const string head =
        ".PROGRAM " + program_.name + "()\n" +
        head_text(program_, "; ", "Joint positions are not computed. Run the dry-run twin first.",
                  kLongestLine);
    const string body = "\n" + entry() + others();
    return head + sha256_hex(head + body) + body;
  }

 private:
  void take(const Move& move) {
    if (parts_.empty() || moves_in_part_ == cell_.max_points) begin_part();
    ++moves_in_part_;
    set_speed(move.speed_mm_s);
    if (above_last_row(move)) {
      line(string(move.joint ? "DEPART " : "DEPARTS ") + vplus_length_text(cell_.clearance_mm));
    } else if (const Move* row = row_below(move)) {
      set_location(row->work_from_tool);
      line(string(move.joint ? "APPRO " : "APPROS ") + cell_.work_name + ":p, " +
           vplus_length_text(cell_.clearance_mm));
    } else {
      set_location(move.work_from_tool);
      line(string(move.joint ? "MOVE " : "MOVES ") + cell_.work_name + ":p");
    }
    stands_ = move.zone_mm == 0.0;
    if (stands_) line("BREAK");
    last_ = &move;
  }

  void begin_part() {
    parts_.emplace_back();
    moves_in_part_ = 0;
    speed_.clear();
    location_.clear();
    last_ = nullptr;
  }

  // Whether the move goes from the row where the robot stands to the clearance above it. Not first in a part:
  // one that is executed by itself must not leave from wherever the robot happens to be.
  [[nodiscard]] bool above_last_row(const Move& move) const {
    return move.row < 0 && last_ != nullptr && last_->row >= 0 && stands_ && is_above(move, *last_);
  }

  // The row that the program goes to from this move, if the move is the clearance above it.
  [[nodiscard]] const Move* row_below(const Move& move) const {
    if (move.row >= 0) return nullptr;
    for (std::size_t i = at_ + 1; i < program_.events.size(); ++i)
      if (const Move* next = std::get_if<Move>(&program_.events[i]))
        return next->row >= 0 && is_above(move, *next) ? next : nullptr;
    return nullptr;
  }

  [[nodiscard]] bool is_above(const Move& move, const Move& row) const {
    return lies_back(move.work_from_tool, row.work_from_tool, cell_.clearance_mm);
  }

  void set_location(const RigidMotion& work_from_tool) {
    const string location = "SET p = " + trans_text(vplus_location(work_from_tool));
    if (location == location_) return;
    line(location);
    location_ = location;
  }

  void take(const SetOutput& set) {
    must_stand("output " + set.output);
    line("SIGNAL " + string(set.on ? "" : "-") + set.output);
  }

  void take(const WaitInput& wait) {
    must_stand("a wait for " + wait.input);
    const string ready = "SIG(" + string(wait.on ? "" : "-") + wait.input + ")";
    line("TIMER 1 = 0");
    line("WAIT " + ready + " OR (TIMER(1) > " + fixed_text(wait.timeout_s, 3) + ")");
    line("IF NOT " + ready + " THEN");
    if (!wait.off.empty()) line("    SIGNAL -" + wait.off);
    line("    TYPE \"Arris: the tool is not ready.\"");
    line("    HALT");
    line("END");
  }

  void must_stand(const string& what) const {
    if (!stands_) throw Error(Fault::kBug, "V+ program: " + what + " behind a move that does not stop");
  }

  void set_speed(double speed_mm_s) {
    const string speed = "SPEED " + speed_text(speed_mm_s) + ", " +
                         fixed_text(100.0 * cell_.turn_speed_ratio, 3) + " MMPS ALWAYS";
    if (speed == speed_) return;
    line(speed);
    speed_ = speed;
  }

  void line(const string& text) {
    if (parts_.empty()) parts_.emplace_back();
    parts_.back() += kIndent + text + "\n";
  }

  [[nodiscard]] string frames() const {
    string text;
    if (cell_.define_tool)
      text += kIndent + "SET " + cell_.tool_name + " = " +
              trans_text(vplus_location(cell_.flange_from_tool)) + "\n";
    text += kIndent + "TOOL " + cell_.tool_name + "\n";
    if (!cell_.define_work) return text;
    text += kIndent + "SET " + cell_.work_name + " = ";
    if (cell_.work_points.empty()) return text + trans_text(vplus_location(cell_.robot_from_work)) + "\n";
    const string origin = cell_.work_points.substr(0, cell_.work_points.find(','));
    return text + "FRAME(" + cell_.work_points + ", " + origin + ")\n";
  }

  // The first program behind its head.
  [[nodiscard]] string entry() const {
    const bool whole = parts_.size() <= 1;
    string text = whole ? kIndent + "AUTO LOC p\n" : "";
    text += kIndent + "SELECT ROBOT = " + std::to_string(cell_.robot_number) + "\n" + kIndent + "ATTACH ()\n";
    if (switches_outputs(program_)) text += kIndent + "REACTE " + trap_name() + "\n";
    text += frames() + kIndent + "CPON ALWAYS\n";
    for (std::size_t i = 0; i < parts_.size(); ++i)
      text += whole ? parts_[i] : kIndent + "CALL " + part_name(i) + "()\n";
    return text + kIndent + "DETACH ()\n.END\n";
  }

  [[nodiscard]] string others() const {
    string text;
    for (std::size_t i = 0; parts_.size() > 1 && i < parts_.size(); ++i)
      text += ".PROGRAM " + part_name(i) + "()\n" + kIndent + "AUTO LOC p\n" + parts_[i] + ".END\n";
    if (!switches_outputs(program_)) return text;
    text += ".PROGRAM " + trap_name() + "()\n";
    for (const string& output : switched_outputs(program_)) text += kIndent + "SIGNAL -" + output + "\n";
    return text + kIndent + "TYPE \"Arris: an error, the tool is switched off.\"\n" + kIndent +
           "HALT\n.END\n";
  }

  [[nodiscard]] string part_name(std::size_t i) const {
    return vplus_part_name(program_.name, std::to_string(i + 1));
  }
  [[nodiscard]] string trap_name() const { return vplus_part_name(program_.name, "e"); }

  const Program& program_;
  const Cell& cell_;
  std::vector<string> parts_;
  string speed_, location_;     // as the part has set them
  const Move* last_ = nullptr;  // of the part
  std::size_t at_ = 0;          // of the events
  int moves_in_part_ = 0;
  bool stands_ = true;
};

}  // namespace

string write_vplus(const Program& program, const std::function<string(std::string_view)>& sha256_hex) {
  check_vplus_names(program);
  return Writer(program).run(sha256_hex);
}

}  // namespace arris
