#include "cli/contours_file.hpp"

#include <gtest/gtest.h>

#include "acquisition/types/error.hpp"
#include "tests/cli/run_arris.hpp"

namespace arris {
namespace {

/// Two triangles of points as contours 1 and 2.
ContourSet two_contours() {
  ContourSet set;
  for (int id = 1; id <= 2; ++id) {
    FoundContour found;
    found.contour.id = id;
    found.contour.closed = id == 1;
    found.contour.source = "angle gap";
    found.contour.points_mm = {{0.1, 0, 0}, {10, id * 1.0, 0}, {0, 10, 0.123456789}};
    if (id == 1) found.contour.normals.assign(3, Eigen::Vector3d::UnitZ());
    set.found.push_back(found);
  }
  return set;
}

ContourChoice chosen() {
  ContourChoice choice = choose(two_contours(), {2}, Eigen::Vector3d(1000, 0, 0));
  choice.file = "part7.ply";
  choice.sha256 = std::string(64, 'a');
  choice.to_mm = 25.4;
  return choice;
}

std::string message_of(const std::filesystem::path& file) {
  try {
    (void)read_contour_choice(file);
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kInput);
    return error.what();
  }
  return {};
}

TEST(ContourChoice, SurvivesTheFile) {
  const testing::TestFolder folder;
  const ContourChoice back =
      read_contour_choice_for(folder.write("c.json", contour_choice_json(chosen())), std::string(64, 'a'));
  EXPECT_EQ(back.file, "part7.ply");
  EXPECT_EQ(back.to_mm, 25.4);
  ASSERT_EQ(back.contours.size(), 2u);
  EXPECT_FALSE(back.contours[0].accepted);
  EXPECT_TRUE(back.contours[0].contour.closed);
  EXPECT_EQ(back.contours[0].contour.normals.size(), 3u);
  ASSERT_EQ(back.accepted().size(), 1u);
  EXPECT_EQ(back.accepted()[0].id, 2);
  EXPECT_TRUE(back.accepted()[0].normals.empty());
  EXPECT_NEAR((back.accepted()[0].points_mm[2] - Eigen::Vector3d(1000, 10, 0.123456789)).norm(), 0.0, 1e-6);
}

TEST(ContourChoice, IsRefusedForAnotherScan) {
  const testing::TestFolder folder;
  const std::filesystem::path file = folder.write("c.json", contour_choice_json(chosen()));
  EXPECT_THROW((void)read_contour_choice_for(file, std::string(64, 'b')), Error);
}

TEST(ContourChoice, UnknownIdIsAUsageError) {
  try {
    (void)choose(two_contours(), {1, 7}, Eigen::Vector3d::Zero());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_STREQ(error.what(), "there is no contour 7 (--accept): needed one of 1, 2");
  }
}

TEST(ContourChoice, RefusesWhatIsNone) {
  const testing::TestFolder folder;
  const std::string good = contour_choice_json(chosen());
  EXPECT_NE(message_of(folder.write("empty.json", "")), "");
  EXPECT_NE(message_of(folder.write("other.json", "{\"a\": 1}")), "");
  EXPECT_NE(message_of(folder.write("list.json", "[1, 2]")), "");
  EXPECT_NE(message_of(folder.write("cut.json", good.substr(0, good.size() / 2))), "");
  EXPECT_NE(message_of(folder.path() / "none.json"), "");
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"\"accept\"", "\"maybe\""},
                                 {"contour choice 1", "contour choice 9"},
                                 {"1010.0", "\"x\""}}) {
    std::string bad = good;
    ASSERT_NE(bad.find(from), std::string::npos) << from;
    bad.replace(bad.find(from), from.size(), to);
    const std::string message = message_of(folder.write("bad.json", bad));
    EXPECT_NE(message.find("this is no contour choice"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace arris
