#include "toolpath/robot/rapid.hpp"

#include <array>
#include <cmath>
#include <map>

#include "acquisition/types/error.hpp"
#include "toolpath/formats/number.hpp"
#include "toolpath/robot/program_text.hpp"
#include "toolpath/robot/rapid_names.hpp"

namespace arris {
namespace {

using std::string;

constexpr int kMmDecimals = 4, kTurnDecimals = 8, kSpeedDecimals = 3;
constexpr double kDegPerRad = 57.295779513082320877;

string triple(const Eigen::Vector3d& v, int decimals) {
  return "[" + fixed_text(v.x(), decimals) + "," + fixed_text(v.y(), decimals) + "," +
         fixed_text(v.z(), decimals) + "]";
}

// Normalised, rounded as it will be written, normalised again; the sign that is nearer to `before`.
Eigen::Vector4d quaternion_wxyz(const Eigen::Matrix3d& turn, const Eigen::Vector4d& before) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(turn).normalized();
  Eigen::Vector4d wxyz(q.w(), q.x(), q.y(), q.z());
  if (wxyz.dot(before) < 0.0) wxyz = -wxyz;
  const double unit = std::pow(10.0, kTurnDecimals);
  return (wxyz * unit).array().round().matrix().normalized();
}

string quadruple(const Eigen::Vector4d& v) {
  return "[" + fixed_text(v[0], kTurnDecimals) + "," + fixed_text(v[1], kTurnDecimals) + "," +
         fixed_text(v[2], kTurnDecimals) + "," + fixed_text(v[3], kTurnDecimals) + "]";
}

string pose_text(const RigidMotion& motion) {
  const Eigen::Vector4d turn = quaternion_wxyz(motion.linear(), Eigen::Vector4d::UnitX());
  return "[" + triple(motion.translation(), kMmDecimals) + "," + quadruple(turn) + "]";
}

// Names for values that are written once and used often: vPath1, vPath2, ... in the order of first use.
class Named {
 public:
  explicit Named(string stem) : stem_(std::move(stem)) {}
  const string& name_of(const string& value) {
    const auto found = names_.find(value);
    if (found != names_.end()) return found->second;
    order_.push_back(value);
    return names_[value] = stem_ + std::to_string(order_.size());
  }
  [[nodiscard]] const std::vector<string>& order() const { return order_; }

 private:
  string stem_;
  std::map<string, string> names_;
  std::vector<string> order_;
};

class Writer {
 public:
  explicit Writer(const Program& program) : program_(program), cell_(program.cell) {}

  string run(const std::function<string(std::string_view)>& sha256_hex) {
    for (const Event& event : program_.events) std::visit([&](const auto& e) { take(e); }, event);
    const string head =
        "MODULE " + program_.name + "\n" +
        head_text(
            program_, "  ! ",
            "Axis configurations are not computed: ConfJ and ConfL are off. Run the dry-run twin first.");
    const string body = "\n" + data() + procedures() + "ENDMODULE\n";
    return head + sha256_hex(head + body) + body;
  }

 private:
  void take(const Move& move) {
    if (parts_.empty() || moves_in_part_ == cell_.max_points) {
      parts_.emplace_back();
      moves_in_part_ = 0;
    }
    ++moves_in_part_;
    const RigidMotion& pose = move.work_from_tool;
    turn_ = quaternion_wxyz(pose.linear(), turn_);
    const string target = "p" + std::to_string(++targets_count_);
    targets_ += "  CONST robtarget " + target + ":=[" + triple(pose.translation(), kMmDecimals) + "," +
                quadruple(turn_) + ",[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n";
    const string speed = speeds_.name_of(speed_data(move.speed_mm_s));
    const string zone = move.zone_mm > 0.0 ? zones_.name_of(zone_text(move.zone_mm)) : "fine";
    line(string(move.joint ? "MoveJ " : "MoveL ") + target + "," + speed + "," + zone + "," +
         cell_.tool_name + "\\WObj:=" + cell_.work_name + ";");
  }

  void take(const SetOutput& set) { line("SetDO " + set.output + "," + (set.on ? "1" : "0") + ";"); }

  void take(const WaitInput& wait) {
    line("WaitDI " + wait.input + "," + (wait.on ? "1" : "0") +
         "\\MaxTime:=" + fixed_text(wait.timeout_s, 3) + "\\TimeFlag:=bReadyLate;");
    line("IF bReadyLate THEN");
    if (!wait.off.empty()) line("  SetDO " + wait.off + ",0;");
    line("  TPWrite \"Arris: the tool is not ready.\";");
    line("  EXIT;");
    line("ENDIF");
    waits_ = true;
  }

  [[nodiscard]] string speed_data(double speed_mm_s) const {
    return "[" + speed_text(speed_mm_s) + "," +
           fixed_text(cell_.turn_speed_rad_s * kDegPerRad, kSpeedDecimals) + ",5000,1000]";
  }

  // Tip, reorientation and external axes alike; a tenth of it in degrees, as in the controller's own z1, z5,
  // z10.
  static string zone_text(double zone_mm) {
    const string z = fixed_text(zone_mm, kMmDecimals), turn_deg = fixed_text(0.1 * zone_mm, kMmDecimals);
    return "[FALSE," + z + "," + z + "," + z + "," + turn_deg + "," + z + "," + turn_deg + "]";
  }

  void line(const string& text) {
    if (parts_.empty()) parts_.emplace_back();
    parts_.back() += "    " + text + "\n";
  }

  [[nodiscard]] string data() const {
    string text;
    if (cell_.define_tool)
      text += "  PERS tooldata " + cell_.tool_name + ":=[TRUE," + pose_text(cell_.flange_from_tool) + ",[" +
              fixed_text(cell_.tool_mass_kg, 3) + "," + triple(cell_.tool_centre_mm, kMmDecimals) +
              ",[1,0,0,0],0,0,0]];\n";
    if (cell_.define_work)
      text += "  PERS wobjdata " + cell_.work_name + ":=[FALSE,TRUE,\"\"," +
              pose_text(cell_.robot_from_work) + ",[[0,0,0],[1,0,0,0]]];\n";
    for (std::size_t i = 0; i < speeds_.order().size(); ++i)
      text += "  CONST speeddata vPath" + std::to_string(i + 1) + ":=" + speeds_.order()[i] + ";\n";
    for (std::size_t i = 0; i < zones_.order().size(); ++i)
      text += "  CONST zonedata zPath" + std::to_string(i + 1) + ":=" + zones_.order()[i] + ";\n";
    if (waits_) text += "  VAR bool bReadyLate:=FALSE;\n";
    return text + targets_;
  }

  [[nodiscard]] string procedures() const {
    string entry = "  PROC " + cell_.entry_name + "()\n    ConfJ\\Off;\n    ConfL\\Off;\n", others;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (parts_.size() == 1) {
        entry += parts_[i];
        continue;
      }
      const string name = "part" + std::to_string(i + 1);
      entry += "    " + name + ";\n";
      others += "  PROC " + name + "()\n" + parts_[i] + "  ENDPROC\n";
    }
    if (switches_outputs(program_))
      entry += "  ERROR\n    SetDO " + cell_.spindle_output + ",0;\n    RAISE;\n";
    return entry + "  ENDPROC\n" + others;
  }

  const Program& program_;
  const Cell& cell_;
  Named speeds_{"vPath"}, zones_{"zPath"};
  Eigen::Vector4d turn_ = Eigen::Vector4d::UnitX();
  string targets_;
  std::vector<string> parts_;
  int moves_in_part_ = 0, targets_count_ = 0;
  bool waits_ = false;
};

}  // namespace

string write_rapid(const Program& program, const std::function<string(std::string_view)>& sha256_hex) {
  check_rapid_names(program);
  return Writer(program).run(sha256_hex);
}

}  // namespace arris
