#include "toolpath/robot/vplus.hpp"

#include "acquisition/types/error.hpp"
#include "toolpath/formats/number.hpp"
#include "toolpath/robot/euler_zyz.hpp"
#include "toolpath/robot/program_text.hpp"
#include "toolpath/robot/vplus_names.hpp"

namespace arris {
namespace {

using std::string;

constexpr int kDecimals = 4;
constexpr std::size_t kLongestLine = 120;
const string kIndent = "        ";

string trans_text(const RigidMotion& motion) {
  const Eigen::Vector3d at_mm = motion.translation();
  const Eigen::Vector3d turn_deg = yaw_pitch_roll_deg(motion.linear(), kDecimals);
  string text = "TRANS(";
  for (double value : {at_mm.x(), at_mm.y(), at_mm.z(), turn_deg.x(), turn_deg.y(), turn_deg.z()})
    text += (text.back() == '(' ? "" : ", ") + fixed_text(value, kDecimals);
  return text + ")";
}

class Writer {
 public:
  explicit Writer(const Program& program) : program_(program), cell_(program.cell) {}

  string run(const std::function<string(std::string_view)>& sha256_hex) {
    for (const Event& event : program_.events) std::visit([&](const auto& e) { take(e); }, event);
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
    if (parts_.empty() || moves_in_part_ == cell_.max_points) {
      parts_.emplace_back();
      moves_in_part_ = 0;
      speed_.clear();
    }
    ++moves_in_part_;
    set_speed(move.speed_mm_s);
    line("SET p = " + trans_text(move.work_from_tool));
    line(string(move.joint ? "MOVE " : "MOVES ") + cell_.work_name + ":p");
    stands_ = move.zone_mm == 0.0;
    if (stands_) line("BREAK");
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
      text += kIndent + "SET " + cell_.tool_name + " = " + trans_text(cell_.flange_from_tool) + "\n";
    text += kIndent + "TOOL " + cell_.tool_name + "\n";
    if (!cell_.define_work) return text;
    text += kIndent + "SET " + cell_.work_name + " = ";
    if (cell_.work_points.empty()) return text + trans_text(cell_.robot_from_work) + "\n";
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
  string speed_;
  int moves_in_part_ = 0;
  bool stands_ = true;
};

}  // namespace

string write_vplus(const Program& program, const std::function<string(std::string_view)>& sha256_hex) {
  check_vplus_names(program);
  return Writer(program).run(sha256_hex);
}

}  // namespace arris
