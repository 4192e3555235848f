#include "toolpath/robot/read_vplus.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "toolpath/robot/read_vplus_grammar.hpp"

namespace arris {
namespace {

using namespace vplus_reader;  // NOLINT: the tree that this file walks
using program_reader::refuse;
using std::string;

// Rz(yaw) Ry(pitch) Rz(roll) as a quaternion, by the half angles.
ReadPose pose_of(const std::array<double, 6>& trans) {
  const double half = 3.14159265358979323846 / 360.0;
  const double sum = half * (trans[3] + trans[5]), rest = half * (trans[3] - trans[5]);
  const double tilt = half * trans[4];
  ReadPose pose;
  pose.xyz_mm = {trans[0], trans[1], trans[2]};
  pose.quat_wxyz = {std::cos(tilt) * std::cos(sum), -std::sin(tilt) * std::sin(rest),
                    std::sin(tilt) * std::cos(rest), std::cos(tilt) * std::sin(sum)};
  return pose;
}

// Moved back along its own z.
ReadPose backed(ReadPose pose, double away_mm) {
  const auto& [w, x, y, z] = pose.quat_wxyz;
  const std::array<double, 3> axis = {2.0 * (x * z + w * y), 2.0 * (y * z - w * x),
                                      1.0 - 2.0 * (x * x + y * y)};
  for (std::size_t i = 0; i < 3; ++i) pose.xyz_mm[i] -= away_mm * axis[i];
  return pose;
}

string written(int number) {
  return std::to_string(number);
}

class Runner {
 public:
  Runner(std::string_view text, const string& file) : file_(parse_vplus(text, file)), source_{file, kVplus} {
    program_reader::read_head(text, file_.comments, source_, out_);
    out_.configurations_off = true;  // a location of numbers states none
  }

  Reading run() {
    const Routine& entry = entry_routine();
    out_.name = entry.written;
    run(entry, 0);
    must_stand(entry.end_line, "the end");
    for (const auto& [key, routine] : file_.routines)
      if (used_.count(key) == 0 && &routine != &entry)
        refuse(source_, routine.line, routine.written, "a program that is called");
    return std::move(out_);
  }

 private:
  const Routine& entry_routine() {
    for (const auto& [key, routine] : file_.routines)
      for (const Statement& statement : routine.body)
        if (statement.kind == StatementKind::kCall || statement.kind == StatementKind::kTrap)
          used_.insert(statement.name.key);
    const Routine* entry = nullptr;
    for (const auto& [key, routine] : file_.routines) {
      if (used_.count(key) > 0) continue;
      if (entry != nullptr) refuse(source_, routine.line, "a second program that none calls", "one entry");
      entry = &routine;
    }
    if (entry == nullptr) refuse(source_, 1, "no program to start with", "one that no other calls");
    return *entry;
  }

  void run(const Routine& routine, int depth) {
    std::map<string, ReadPose> locals;
    std::set<string> declared;
    int moves = 0;
    const std::vector<Statement>& body = routine.body;
    for (std::size_t i = 0; i < body.size(); ++i) {
      const Statement& now = body[i];
      switch (now.kind) {
        case StatementKind::kAuto:
          if (!declared.insert(now.name.key).second)
            refuse(source_, now.line, "a second " + now.name.written, "each name once");
          break;
        case StatementKind::kSet:
          if (declared.count(now.name.key) == 0)
            set_global(now);
          else if (now.literal)
            locals[now.name.key] = pose_of(now.trans);
          else
            refuse(source_, now.line, "a FRAME in a variable of the program", "one that all programs see");
          break;
        case StatementKind::kMove:
        case StatementKind::kDepart:
          move(now, locals, i + 1 < body.size() && body[i + 1].kind == StatementKind::kBreak);
          out_.longest_procedure = std::max(out_.longest_procedure, ++moves);
          break;
        case StatementKind::kWait:
          i += wait(body, i);
          break;
        case StatementKind::kCall:
          call(now, depth);
          break;
        default:
          simple(now, depth);
      }
    }
  }

  void simple(const Statement& now, int depth) {
    switch (now.kind) {
      case StatementKind::kSelect:
        if (out_.robot) refuse(source_, now.line, "a second SELECT ROBOT", "one");
        out_.robot = now.number;
        break;
      case StatementKind::kAttach:
        if (!now.on) must_stand(now.line, "DETACH");
        if (now.on == attached_) refuse(source_, now.line, "ATTACH or DETACH twice", "one after the other");
        attached_ = now.on;
        break;
      case StatementKind::kTrap:
        trap(now, depth);
        break;
      case StatementKind::kTool:
        tool(now);
        break;
      case StatementKind::kSpeed:
        speed_mm_s_ = now.speed_mm_s;
        if (now.turn_percent > 0.0) turn_ratio_ = 0.01 * now.turn_percent;
        break;
      case StatementKind::kBreak:
        moving_ = false;
        break;
      case StatementKind::kSignal:
        must_stand(now.line, "a SIGNAL");
        out_.events.emplace_back(ReadSet{written(now.number), now.on ? 1 : 0});
        break;
      case StatementKind::kTimer:
      case StatementKind::kPrint:
      case StatementKind::kContinuous:
        break;
      default:
        refuse(source_, now.line, "an IF or HALT here", "IF behind its WAIT, HALT in it or in a trap");
    }
  }

  void must_stand(int line, const string& what) const {
    if (moving_) refuse(source_, line, what + " while the robot moves", "BREAK before it");
  }

  void set_global(const Statement& now) {
    if (fixed_.count(now.name.key) > 0)
      refuse(source_, now.line, "a frame or tool that changes: " + now.name.written, "one value");
    globals_.erase(now.name.key);
    taught_.erase(now.name.key);
    if (now.literal)
      globals_[now.name.key] = {now.name.written, pose_of(now.trans)};
    else
      taught_[now.name.key] = {
          now.name.written,
          {now.points[0].written, now.points[1].written, now.points[2].written, now.points[3].written}};
  }

  void tool(const Statement& now) {
    must_stand(now.line, "TOOL");
    if (taught_.count(now.name.key) > 0)
      refuse(source_, now.line, "a tool of taught points", "TRANS, or a tool that the controller has");
    fixed_.insert(now.name.key);
    last_.reset();  // the place of another tip
    const auto found = globals_.find(now.name.key);
    tool_ = found == globals_.end() ? now.name.written : found->second.first;
    if (found != globals_.end()) out_.tools[tool_].flange_from_tool = found->second.second;
  }

  // The frame's name as it is declared; notes its value where the program sets it.
  string frame(const Name& name) {
    if (name.key.empty()) return "";
    fixed_.insert(name.key);
    if (const auto found = globals_.find(name.key); found != globals_.end()) {
      out_.works[found->second.first] = found->second.second;
      return found->second.first;
    }
    if (const auto found = taught_.find(name.key); found != taught_.end()) {
      out_.taught_works[found->second.first] = found->second.second;
      return found->second.first;
    }
    return name.written;
  }

  ReadPose point(const Statement& now, const std::map<string, ReadPose>& locals) const {
    if (now.literal) return pose_of(now.trans);
    if (const auto found = locals.find(now.point.key); found != locals.end()) return found->second;
    if (const auto found = globals_.find(now.point.key); found != globals_.end()) return found->second.second;
    refuse(source_, now.line, "the location " + now.point.written, "one that the program sets");
  }

  void move(const Statement& now, const std::map<string, ReadPose>& locals, bool stops) {
    if (!speed_mm_s_) refuse(source_, now.line, "a move without a speed", "SPEED .. MMPS ALWAYS before it");
    if (!attached_) refuse(source_, now.line, "a move of a robot that is not attached", "ATTACH ()");
    ReadMove read;
    read.joint = now.joint;
    if (now.kind == StatementKind::kMove) {
      last_ = point(now, locals);
      work_ = frame(now.name);
    } else {
      must_stand(now.line, "a DEPART");
      if (!last_) refuse(source_, now.line, "a DEPART from a place that is not known", "a move before it");
    }
    last_ = backed(*last_, now.away_mm);
    read.pose = *last_;
    read.work = work_;
    read.tool = tool_;
    read.speed_mm_s = *speed_mm_s_;
    read.turn_ratio = turn_ratio_;
    read.zone_mm = stops ? std::optional<double>(0.0) : std::nullopt;
    moving_ = true;
    out_.events.emplace_back(std::move(read));
  }

  // How many statements behind the WAIT belong to it.
  std::size_t wait(const std::vector<Statement>& body, std::size_t i) {
    const Statement& now = body[i];
    must_stand(now.line, "a WAIT");
    ReadWait read;
    read.input = written(now.number);
    read.value = now.on ? 1 : 0;
    read.timeout_s = now.timeout_s;
    if (now.timer == 0) {
      out_.events.emplace_back(std::move(read));
      return 0;
    }
    if (i == 0 || body[i - 1].kind != StatementKind::kTimer || body[i - 1].timer != now.timer)
      refuse(source_, now.line, "a timer that may be at any time", "TIMER " + written(now.timer) + " = 0");
    const Statement* next = i + 1 < body.size() ? &body[i + 1] : nullptr;
    if (next == nullptr || next->kind != StatementKind::kIf || next->number != now.number ||
        next->on != now.on)
      refuse(source_, now.line, "a WAIT with a time that is not looked at", "IF NOT of the same signal next");
    read.on_timeout = handled(next->body, next->line);
    read.ends_on_timeout = true;
    out_.events.emplace_back(std::move(read));
    return 1;
  }

  // Signals that are switched before the HALT of a time-out or a trap.
  std::vector<ReadSet> handled(const std::vector<Statement>& body, int line) const {
    std::vector<ReadSet> sets;
    bool ended = false;
    for (const Statement& statement : body) {
      if (ended)
        refuse(source_, statement.line, "a statement that is never reached", "the end of the handler");
      if (statement.kind == StatementKind::kSignal)
        sets.push_back({written(statement.number), statement.on ? 1 : 0});
      else if (statement.kind == StatementKind::kHalt)
        ended = true;
      else if (statement.kind != StatementKind::kPrint)
        refuse(source_, statement.line, "another statement in a handler", "SIGNAL, TYPE or HALT");
    }
    if (!ended) refuse(source_, line, "a handler that goes on", "HALT at its end");
    return sets;
  }

  const Routine& routine(const Statement& now) const {
    const auto found = file_.routines.find(now.name.key);
    if (found == file_.routines.end())
      refuse(source_, now.line, "the program " + now.name.written, "a program of this file");
    return found->second;
  }

  // A trap set behind a signal would leave that signal unguarded.
  void trap(const Statement& now, int depth) {
    if (depth > 0 || trapped_ || !out_.events.empty())
      refuse(source_, now.line, "a REACTE here", "one, before the first move and signal");
    trapped_ = true;
    const Routine& found = routine(now);
    out_.on_error = handled(found.body, found.end_line);
  }

  void call(const Statement& now, int depth) {
    const Routine& found = routine(now);
    if (depth > 0) refuse(source_, now.line, "a call within a call", "calls in the first program alone");
    run(found, depth + 1);
  }

  File file_;
  Source source_;
  Reading out_;
  std::set<string> used_, fixed_;
  std::map<string, std::pair<string, ReadPose>> globals_;  // by key: as declared, value
  std::map<string, std::pair<string, TaughtWork>> taught_;
  std::optional<ReadPose> last_;
  std::optional<double> speed_mm_s_;
  double turn_ratio_ = 1.0;  // as every program of V+ starts
  string tool_, work_;
  bool attached_ = false, moving_ = false, trapped_ = false;
};

}  // namespace

Reading read_vplus(std::string_view text, const string& source) {
  return Runner(text, source).run();
}

}  // namespace arris
