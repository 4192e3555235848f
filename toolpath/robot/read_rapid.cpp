#include "toolpath/robot/read_rapid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "toolpath/robot/read_rapid_grammar.hpp"

namespace arris {
namespace {

using namespace rapid_reader;  // NOLINT: the tree that this file walks
using program_reader::refuse;
using std::string;

// The shape of data, as a pattern: b truth, s text, n number, u 9E9, ( ) a list.
struct Shape {
  const Source& source;
  const Declaration& of;
  const char* pattern;
  std::vector<double> numbers;
  std::vector<bool> truths;

  void match(const Value& value) {
    const auto wrong = [&] {
      refuse(source, value.line, "a " + of.type + " of another shape", "the parts of " + of.type);
    };
    const char c = *pattern++;
    const bool fits =
        (c == 'b' && value.kind == ValueKind::kTruth) || (c == 's' && value.kind == ValueKind::kText) ||
        (c == 'n' && value.kind == ValueKind::kNumber) || (c == 'u' && value.kind == ValueKind::kUnused) ||
        (c == '(' && value.kind == ValueKind::kList);
    if (!fits) wrong();
    if (c == 'b') truths.push_back(value.truth);
    if (c == 'n') numbers.push_back(value.number);
    if (c != '(') return;
    for (const Value& item : value.items) {
      if (*pattern == ')') wrong();
      match(item);
    }
    if (*pattern++ != ')') wrong();
  }
};

Shape shaped(const Source& source, const Declaration& of, const Value& value, const char* pattern) {
  Shape shape{source, of, pattern, {}, {}};
  shape.match(value);
  return shape;
}

ReadPose pose_at(const std::vector<double>& n, std::size_t begin, const Source& source, int line) {
  ReadPose pose;
  double length2 = 0.0;
  for (std::size_t i = 0; i < 3; ++i) pose.xyz_mm[i] = n[begin + i];
  for (std::size_t i = 0; i < 4; ++i) {
    pose.quat_wxyz[i] = n[begin + 3 + i];
    length2 += n[begin + 3 + i] * n[begin + 3 + i];
  }
  if (std::abs(std::sqrt(length2) - 1.0) > 1e-6)
    refuse(source, line, "a quaternion of length " + std::to_string(std::sqrt(length2)), "length 1");
  return pose;
}

// Speeds and zones that every controller knows.
const std::set<int> kSpeeds = {5,   10,  20,  30,   40,   50,   60,   80,   100,  150,  200,  300, 400,
                               500, 600, 800, 1000, 1500, 2000, 2500, 3000, 4000, 5000, 6000, 7000};
const std::set<int> kZones = {0, 1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200};

std::optional<int> predefined(const string& key, char stem, const std::set<int>& known) {
  if (key.size() < 2 || key.size() > 5 || key[0] != stem || (key[1] == '0' && key.size() > 2))
    return std::nullopt;
  int value = 0;
  for (char c : key.substr(1)) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return known.count(value) > 0 ? std::optional<int>(value) : std::nullopt;
}

class Runner {
 public:
  Runner(std::string_view text, const string& file)
      : module_(parse_rapid(text, file)), source_{file, "RAPID"} {
    out_.name = module_.name;
    program_reader::read_head(text, module_.comments, source_, out_);
  }

  Reading run() {
    tools_and_works();
    const Procedure& entry = entry_procedure();
    run(entry.body, 0);
    out_.on_error = handled(entry.on_error, StatementKind::kRaise).first;
    out_.configurations_off = moved_ && !conf_seen_on_;
    for (const auto& [key, procedure] : module_.procedures)
      if (called_.count(key) == 0 && &procedure != &entry)
        refuse(source_, procedure.line, key, "a procedure that is called");
    return std::move(out_);
  }

 private:
  const Declaration& data(const Name& name, const char* type, int line) const {
    const auto found = module_.data.find(name.key);
    if (found == module_.data.end() || found->second.type != type || !found->second.has_value)
      refuse(source_, line, "the name " + name.written,
             "a " + string(type) + " that is declared with a value");
    return found->second;
  }

  void tools_and_works() {
    for (const auto& [key, found] : module_.data) {
      if (found.type != "tooldata" && found.type != "wobjdata") continue;
      if (found.storage != "pers") refuse(source_, found.line, found.storage + " " + found.type, "PERS");
      if (!found.has_value) refuse(source_, found.line, found.written + " without a value", "a value");
      if (found.type == "tooldata")
        tool(found);
      else
        work(found);
    }
  }

  void tool(const Declaration& found) {
    const Shape shape = shaped(source_, found, found.value, "(b((nnn)(nnnn))(n(nnn)(nnnn)nnn))");
    ReadTool read;
    read.flange_from_tool = pose_at(shape.numbers, 0, source_, found.line);
    ReadLoad& load = read.load.emplace();
    load.mass_kg = shape.numbers[7];
    for (std::size_t i = 0; i < 3; ++i) load.centre_mm[i] = shape.numbers[8 + i];
    if (!shape.truths[0])
      refuse(source_, found.line, "a tool that stands still", "a tool that the robot holds");
    if (!(load.mass_kg > 0.0)) refuse(source_, found.line, "a tool without mass", "a mass above 0");
    out_.tools[found.written] = read;
  }

  void work(const Declaration& found) {
    const Shape shape = shaped(source_, found, found.value, "(bbs((nnn)(nnnn))((nnn)(nnnn)))");
    if (shape.truths[0] || !shape.truths[1])
      refuse(source_, found.line, "a work object that moves", "a fixed one");
    const ReadPose user = pose_at(shape.numbers, 0, source_, found.line);
    const ReadPose object = pose_at(shape.numbers, 7, source_, found.line);
    for (double part : {object.xyz_mm[0], object.xyz_mm[1], object.xyz_mm[2], object.quat_wxyz[0] - 1.0})
      if (part != 0.0) refuse(source_, found.line, "an object frame of its own", "[[0,0,0],[1,0,0,0]]");
    out_.works[found.written] = user;
  }

  const Procedure& entry_procedure() {
    const auto note_calls = [&](const std::vector<Statement>& body) {
      for (const Statement& statement : body)
        if (statement.kind == StatementKind::kCall) called_.insert(statement.signal.key);
    };
    for (const auto& [key, procedure] : module_.procedures) note_calls(procedure.body);
    const Procedure* entry = nullptr;
    for (const auto& [key, procedure] : module_.procedures) {
      if (called_.count(key) > 0) continue;
      if (entry != nullptr)
        refuse(source_, procedure.line, "a second procedure that none calls", "one entry");
      entry = &procedure;
    }
    if (entry == nullptr) refuse(source_, 1, "no procedure to start with", "one that no other calls");
    return *entry;
  }

  void run(const std::vector<Statement>& body, int depth) {
    int moves = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      const Statement& statement = body[i];
      switch (statement.kind) {
        case StatementKind::kConf:
          (statement.joint ? conf_j_on_ : conf_l_on_) = statement.on;
          break;
        case StatementKind::kMove:
          move(statement);
          out_.longest_procedure = std::max(out_.longest_procedure, ++moves);
          break;
        case StatementKind::kSet:
          out_.events.emplace_back(ReadSet{statement.signal.written, statement.value});
          break;
        case StatementKind::kWait:
          wait(statement, i + 1 < body.size() ? &body[i + 1] : nullptr);
          i += statement.flag.key.empty() ? 0 : 1;
          break;
        case StatementKind::kPrint:
          break;
        case StatementKind::kCall:
          call(statement, depth);
          break;
        default:
          refuse(source_, statement.line, "an IF, EXIT or RAISE here",
                 "IF behind its WaitDI, the others in IF or ERROR");
      }
    }
  }

  void call(const Statement& statement, int depth) {
    const auto found = module_.procedures.find(statement.signal.key);
    if (found == module_.procedures.end())
      refuse(source_, statement.line, "a call of " + statement.signal.written, "a procedure of this module");
    if (depth > 0)
      refuse(source_, statement.line, "a call within a call", "calls in the entry procedure alone");
    if (!found->second.on_error.empty())
      refuse(source_, found->second.line, "an error handler of its own", "one in the entry procedure");
    run(found->second.body, depth + 1);
  }

  void wait(const Statement& statement, const Statement* next) {
    ReadWait read;
    read.input = statement.signal.written;
    read.value = statement.value;
    read.timeout_s = statement.timeout_s;
    if (!statement.flag.key.empty()) {
      const Declaration& flag = data(statement.flag, "bool", statement.line);
      if (flag.storage == "const") refuse(source_, statement.line, "a flag that cannot change", "a VAR");
      if (statement.timeout_s <= 0.0) refuse(source_, statement.line, "a flag without a time", "\\MaxTime");
      if (next == nullptr || next->kind != StatementKind::kIf || next->signal.key != statement.flag.key)
        refuse(source_, statement.line, "a WaitDI whose flag is not looked at",
               "IF " + statement.flag.written + " THEN next");
      std::tie(read.on_timeout, read.ends_on_timeout) = handled(next->body, StatementKind::kExit);
    }
    out_.events.emplace_back(std::move(read));
  }

  // Outputs that a handler switches, and whether it ends as it must.
  std::pair<std::vector<ReadSet>, bool> handled(const std::vector<Statement>& body,
                                                StatementKind ends_with) const {
    std::vector<ReadSet> sets;
    bool ended = false;
    for (const Statement& statement : body) {
      if (ended)
        refuse(source_, statement.line, "a statement that is never reached", "the end of the handler");
      if (statement.kind == StatementKind::kSet)
        sets.push_back({statement.signal.written, statement.value});
      else if (statement.kind == ends_with)
        ended = true;
      else if (statement.kind != StatementKind::kPrint)
        refuse(source_, statement.line, "another statement in a handler", "SetDO, TPWrite, EXIT or RAISE");
    }
    if (!body.empty() && !ended)
      refuse(source_, body.back().line, "a handler that goes on", "EXIT in IF, RAISE in ERROR");
    return {sets, ended};
  }

  void move(const Statement& statement) {
    ReadMove read;
    read.joint = statement.joint;
    read.pose = target(statement);
    read.tool = known(statement.tool, "tooldata", "tool0", statement.line);
    read.work =
        statement.work.key.empty() ? "wobj0" : known(statement.work, "wobjdata", "wobj0", statement.line);
    speed(statement, read);
    zone(statement, read);
    moved_ = true;
    conf_seen_on_ = conf_seen_on_ || (statement.joint ? conf_j_on_ : conf_l_on_);
    out_.events.emplace_back(std::move(read));
  }

  // A tool or work object of the module by its declared spelling; one that the controller has, as it stands.
  string known(const Name& name, const char* type, const char* standard, int line) const {
    const auto found = module_.data.find(name.key);
    if (found == module_.data.end()) return name.key == standard ? standard : name.written;
    return data(name, type, line).written;
  }

  ReadPose target(const Statement& statement) const {
    Declaration literal;
    literal.type = "robtarget";
    const bool named = !statement.target.key.empty();
    const Declaration& of = named ? data(statement.target, "robtarget", statement.line) : literal;
    const Value& value = named ? of.value : statement.literal;
    const Shape shape = shaped(source_, of, value, "((nnn)(nnnn)(nnnn)(uuuuuu))");
    for (std::size_t i = 7; i < 11; ++i)
      if (shape.numbers[i] != std::floor(shape.numbers[i]) || std::abs(shape.numbers[i]) > 11.0)
        refuse(source_, value.line, "a configuration that is none", "four whole numbers");
    ReadPose pose = pose_at(shape.numbers, 0, source_, value.line);
    for (std::size_t i = 0; i < 3; ++i) pose.xyz_mm[i] += statement.offset_mm[i];
    return pose;
  }

  void speed(const Statement& statement, ReadMove& read) const {
    const std::optional<int> standard = predefined(statement.speed.key, 'v', kSpeeds);
    if (standard && module_.data.count(statement.speed.key) == 0) {
      read.speed_mm_s = *standard;
      read.turn_deg_s = 500.0;
      return;
    }
    const Declaration& found = data(statement.speed, "speeddata", statement.line);
    const Shape shape = shaped(source_, found, found.value, "(nnnn)");
    for (double part : shape.numbers)
      if (!(part > 0.0)) refuse(source_, found.line, "a speed that is not above 0", "four speeds above 0");
    read.speed_mm_s = shape.numbers[0];
    read.turn_deg_s = shape.numbers[1];
  }

  void zone(const Statement& statement, ReadMove& read) const {
    if (statement.zone.key == "fine") return;
    const std::optional<int> standard = predefined(statement.zone.key, 'z', kZones);
    if (standard && module_.data.count(statement.zone.key) == 0) {
      read.zone_mm = *standard == 0 ? 0.3 : *standard;
      return;
    }
    const Declaration& found = data(statement.zone, "zonedata", statement.line);
    const Shape shape = shaped(source_, found, found.value, "(bnnnnnn)");
    for (double part : shape.numbers)
      if (part < 0.0) refuse(source_, found.line, "a negative zone", "zones of at least 0");
    if (shape.numbers[1] < shape.numbers[0])
      refuse(source_, found.line, "pzone_ori below pzone_tcp", "at least as much");
    read.zone_mm = shape.truths[0] ? 0.0 : shape.numbers[0];
  }

  Module module_;
  Source source_;
  Reading out_;
  std::set<string> called_;
  bool conf_j_on_ = true, conf_l_on_ = true, conf_seen_on_ = false, moved_ = false;
};

}  // namespace

Reading read_rapid(std::string_view text, const string& source) {
  return Runner(text, source).run();
}

}  // namespace arris
