// Every robot language: what is written comes back by the recogniser, and nothing else passes for it.
#include <gtest/gtest.h>

#include <random>

#include "acquisition/types/error.hpp"
#include "tests/toolpath/programs.hpp"
#include "toolpath/robot/compare.hpp"
#include "toolpath/robot/dialect.hpp"

namespace arris {
namespace {

using test::random_program;
using test::toy_hash;

// Degrees between a rotation and a quaternion, by the quaternion's own rotation formula written out.
double turn_deg(const Eigen::Matrix3d& meant, const std::array<double, 4>& q) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  Eigen::Matrix3d read;
  read << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
      1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x),
      1 - 2 * (x * x + y * y);
  return (read - meant).norm() / std::sqrt(2.0) * 57.29577951308232;  // chord of the angle; small angles
}

class RoundTrip : public testing::TestWithParam<Dialect> {
 protected:
  [[nodiscard]] static std::string text_of(const Program& program) {
    return GetParam().write(program, toy_hash);
  }
  [[nodiscard]] static Reading read(const std::string& text) { return GetParam().read(text, "program"); }
  [[nodiscard]] static std::string word() { return GetParam().word; }
};

TEST_P(RoundTrip, TenThousandPosesComeBackWithinAThousandth) {
  const Program meant = random_program(1, 10000, word());
  const std::string text = text_of(meant);
  const Reading read = RoundTrip::read(text);
  ASSERT_EQ(read.events.size(), meant.events.size());
  double worst_mm = 0.0, worst_deg = 0.0;
  int poses = 0;
  for (std::size_t i = 0; i < meant.events.size(); ++i) {
    ASSERT_EQ(read.events[i].index(), meant.events[i].index()) << i;
    const auto* move = std::get_if<Move>(&meant.events[i]);
    if (move == nullptr) continue;
    ++poses;
    const ReadPose& pose = std::get<ReadMove>(read.events[i]).pose;
    const Eigen::Vector3d xyz_mm(pose.xyz_mm[0], pose.xyz_mm[1], pose.xyz_mm[2]);
    worst_mm = std::max(worst_mm, (xyz_mm - move->work_from_tool.translation()).norm());
    worst_deg = std::max(worst_deg, turn_deg(move->work_from_tool.linear(), pose.quat_wxyz));
  }
  RecordProperty("worst_mm", std::to_string(worst_mm));
  RecordProperty("worst_deg", std::to_string(worst_deg));
  EXPECT_EQ(poses, 10000);
  EXPECT_LE(worst_mm, 0.001);
  EXPECT_LE(worst_deg, 0.001);
  EXPECT_EQ(differences(meant, read, toy_hash), std::vector<std::string>());
  for (const char* zero : {"-0.0000,", "-0.0000)", "-0.0000]"}) EXPECT_EQ(text.find(zero), std::string::npos);
  for (char c : text) ASSERT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
  EXPECT_EQ(read.longest_procedure, 5000);
}

TEST_P(RoundTrip, ProgramsOfCorrectionsComeBack) {
  for (bool dry_run : {false, true}) {
    for (Spin spin : {Spin::kFixed, Spin::kTangent, Spin::kLeastTurn}) {
      Correction correction = test::ring(90, 60.0, true);
      for (const CorrectedPoint& row : test::ring(40, 25.0, false, 2).points)
        correction.points.push_back(row);
      ProgramOptions options;
      options.dry_run = dry_run;
      options.spin = spin;
      options.result_hash = toy_hash("x");
      const Program program =
          make_program(correction, Eigen::Vector3d(10.0, 20.0, 30.0), test::some_cell(word()), options);
      EXPECT_EQ(differences(program, read(text_of(program)), toy_hash), std::vector<std::string>());
    }
  }
}

TEST_P(RoundTrip, ACellThatKnowsItsToolAndLinesDoesNotHaveThemRedefined) {
  Cell cell = test::some_cell(word());
  cell.define_tool = cell.define_work = false;
  cell.tool_name = "tool0";
  cell.spindle_output.clear();
  cell.spindle_ready.clear();
  const Program program = make_program(test::ring(20, 60.0, true), Eigen::Vector3d::Zero(), cell, {});
  const Reading found = read(text_of(program));
  EXPECT_TRUE(found.tools.empty());
  EXPECT_TRUE(found.works.empty());
  for (const ReadEvent& event : found.events) EXPECT_TRUE(std::holds_alternative<ReadMove>(event));
  EXPECT_EQ(differences(program, found, toy_hash), std::vector<std::string>());
}

enum class Caught { kByGrammar, kByComparison, kByHash, kNot };

Caught caught(const Dialect& dialect, const Program& meant, const std::string& text) {
  try {
    const Reading read = dialect.read(text, "mutated");
    const auto no_hash = [&](std::string_view) { return read.body_sha256; };
    if (!differences(meant, read, no_hash).empty()) return Caught::kByComparison;
    return differences(meant, read, toy_hash).empty() ? Caught::kNot : Caught::kByHash;
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kInput) << error.what();
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
    return Caught::kByGrammar;
  }
}

TEST_P(RoundTrip, EveryMutationIsCaught) {
  const Program meant = random_program(2, 60, word());
  const std::string text = text_of(meant);
  ASSERT_EQ(caught(GetParam(), meant, text), Caught::kNot);
  std::mt19937_64 random(3);
  int count[4] = {0, 0, 0, 0};
  for (int i = 0; i < 3000; ++i) {
    std::string mutated = text;
    const std::size_t at = random() % text.size();
    if (i % 2 == 0) {
      mutated.erase(at, 1);
    } else {
      char other = mutated[at];
      while (other == mutated[at]) other = static_cast<char>(' ' + random() % 95);
      mutated[at] = other;
    }
    if (mutated == text) continue;
    const Caught how = caught(GetParam(), meant, mutated);
    ++count[static_cast<int>(how)];
    EXPECT_NE(how, Caught::kNot) << "at " << at << ": " << text.substr(at > 30 ? at - 30 : 0, 60);
  }
  RecordProperty("caught_by_grammar", count[0]);
  RecordProperty("caught_by_comparison", count[1]);
  RecordProperty("caught_by_hash_alone", count[2]);
  EXPECT_EQ(count[3], 0);
}

// What the hash alone catches must be without effect: nothing that moves the robot by more than the
// tolerance.
TEST_P(RoundTrip, ComparisonAloneCatchesEveryDigitThatMatters) {
  const Program meant = random_program(4, 12, word());
  const std::string text = text_of(meant);
  const std::string before_x = word() == "rapid" ? " robtarget p" : "SET p = TRANS(";
  int tried = 0;
  for (std::size_t at = 0; (at = text.find(before_x, at)) != std::string::npos; ++at) {
    const std::size_t point = text.find('.', at);
    for (std::size_t digit : {point - 1, point + 1, point + 2}) {  // 1, 0.1 and 0.01 mm of x
      std::string mutated = text;
      mutated[digit] = mutated[digit] == '9' ? '4' : static_cast<char>(mutated[digit] + 1);
      const Caught how = caught(GetParam(), meant, mutated);
      EXPECT_TRUE(how == Caught::kByComparison || how == Caught::kByGrammar);
    }
    ++tried;
  }
  EXPECT_EQ(tried, 12);
}

TEST_P(RoundTrip, EveryTruncationIsCaught) {
  const Program meant = random_program(5, 12, word());
  const std::string text = text_of(meant);
  for (std::size_t length = 0; length < text.size(); ++length)
    EXPECT_NE(caught(GetParam(), meant, text.substr(0, length)), Caught::kNot) << length;
}

TEST_P(RoundTrip, TheSameBytesEveryTime) {
  const Program meant = random_program(6, 40, word());
  EXPECT_EQ(text_of(meant), text_of(meant));
  EXPECT_EQ(&dialect_from_name(word()), &dialect_from_name(word()));
}

INSTANTIATE_TEST_SUITE_P(Languages, RoundTrip, testing::ValuesIn(dialects()),
                         [](const auto& one) { return std::string(one.param.word); });

TEST(Dialects, ACellIsCheckedBeforeThereIsAPath) {
  for (const Dialect& dialect : dialects()) {
    EXPECT_NO_THROW(check_cell(dialect, test::some_cell(dialect.word)));
    Cell reserved = test::some_cell(dialect.word);
    reserved.tool_name = "then";
    EXPECT_THROW(check_cell(dialect, reserved), Error) << dialect.word;
  }
  EXPECT_THROW(check_cell(dialect_from_name("vplus"), test::some_cell("rapid")), Error);  // lines by name
  Cell long_name = test::some_cell("vplus");
  long_name.program_name = "ArrisPortholeA";  // its trap would be cut to another name
  EXPECT_THROW(check_cell(dialect_from_name("vplus"), long_name), Error);
}

TEST(Dialects, AnUnknownWordIsRefused) {
  EXPECT_THROW((void)dialect_from_name("basic"), Error);
  EXPECT_STREQ(dialect_from_name("vplus").extension, ".v2");
}

}  // namespace
}  // namespace arris
