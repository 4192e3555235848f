#include "cli/recipe.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <regex>
#include <tuple>

#include "cli/recipe_options.hpp"
#include "tests/cli/run_arris.hpp"

namespace arris {
namespace {

const std::string kStarred =
    "[part]\nnumber = \"A-1\"\ncad = \"a.stl\"\ncad_units = \"mm\"\n[scan]\nunits = \"mm\"\n";

RecipeRead parse(const std::string& text) {
  return parse_recipe("shop/part.toml", text);
}

/// The first problem as the line that the operator reads.
std::string problem_of(const std::string& text) {
  const RecipeRead read = parse(text);
  return read.problems.empty() ? std::string() : to_line(read.problems.front());
}

std::string joined(const std::vector<ErrorText>& problems) {
  std::string lines;
  for (const ErrorText& problem : problems) lines += to_line(problem) + "\n";
  return lines;
}

/// The starred keys of a printed recipe, filled in.
std::string filled(std::string text) {
  for (const auto& [empty, full] : {std::pair<std::string, std::string>{"number = \"\"", "number = \"A-1\""},
                                    {"cad = \"\"", "cad = \"a.stl\""},
                                    {"cad_units = \"\"", "cad_units = \"inch\""},
                                    {"\nunits = \"\"", "\nunits = \"m\""}}) {
    const auto at = text.find(empty);
    EXPECT_NE(at, std::string::npos) << empty;
    text.replace(at, empty.size(), full);
  }
  return text;
}

/// A value of the key that is valid and not its default, as TOML.
std::string other_value(const Key& key) {
  if (!key.words.empty()) return quote(key.words.back());
  if (!key.example.empty()) return key.example;
  if (std::holds_alternative<std::string*>(key.slot)) return "\"other\"";
  if (std::holds_alternative<std::filesystem::path*>(key.slot)) return "\"other.stl\"";
  if (auto* const* flag = std::get_if<bool*>(&key.slot)) return **flag ? "false" : "true";
  if (auto* const* whole = std::get_if<int*>(&key.slot))
    return std::to_string(**whole < key.max ? **whole + 1 : **whole);
  if (auto* const* number = std::get_if<double*>(&key.slot)) {
    const double next = **number + 0.25;
    return next <= key.max ? std::to_string(next) : std::to_string(0.5 * (**number + key.min));
  }
  ADD_FAILURE() << "no other value for " << key.name;
  return {};
}

TEST(Recipe, EveryKeyIsSettable) {
  Recipe defaults;
  for (const Key& key : recipe_keys(defaults)) {
    const auto dot = key.name.rfind('.');
    const std::string table = dot == std::string::npos ? "" : key.name.substr(0, dot);
    const std::string line =
        key.name.substr(dot == std::string::npos ? 0 : dot + 1) + " = " + other_value(key) + "\n";
    const RecipeRead read = parse(table.empty() ? line : "[" + table + "]\n" + line);
    // Other keys are missing, and may not fit together; this one is read.
    for (const ErrorText& problem : read.problems)
      EXPECT_FALSE(problem.what.starts_with(key.name + " ") && problem.what != key.name + " is missing")
          << to_line(problem);
    Recipe copy = read.recipe;
    for (const Key& after : recipe_keys(copy))
      if (after.name == key.name && key.words.size() != 1 && key.name != "schema") {
        EXPECT_NE(value_text(after), value_text(key)) << key.name;
      }
  }
}

TEST(Recipe, TableOfKeysKeepsItsLaws) {
  Recipe recipe;
  std::set<std::string> names, closed_tables;
  std::string table;
  for (const Key& key : recipe_keys(recipe)) {
    EXPECT_TRUE(names.insert(key.name).second) << key.name << " stands twice";
    const auto dot = key.name.rfind('.');
    const std::string here = dot == std::string::npos ? "" : key.name.substr(0, dot);
    if (here != table) {
      EXPECT_TRUE(closed_tables.insert(table).second) << "[" << here << "] is torn apart";
      table = here;
    }
    EXPECT_FALSE(key.about.empty()) << key.name;
    EXPECT_LE(key.about.size(), 115u) << key.name;
    EXPECT_TRUE(key.later.empty() || !key.words.empty()) << key.name;
    const bool set = value_text(key) != "\"\"" && value_text(key) != "[]";
    EXPECT_TRUE(set || key.required) << key.name << " has neither default nor example";
    if (set && !value_text(key).empty()) {
      EXPECT_FALSE(check_value(key)) << key.name << ": its default is refused";
    }
  }
}

TEST(Recipe, PrintedDefaultsPassWhenTheStarredKeysAreFilled) {
  const RecipeRead read = parse(filled(print_recipe(Recipe())));
  EXPECT_TRUE(read.problems.empty()) << joined(read.problems);
  EXPECT_FALSE(read.recipe.toolpath.from_contour.given);
  EXPECT_FALSE(read.recipe.scan.initial.given);
  EXPECT_FALSE(read.recipe.part.thickness_mm.has_value());
}

TEST(Recipe, PrintedDefaultsNameTheStarredKeysWhenTheyAreNotFilled) {
  const RecipeRead read = parse(print_recipe(Recipe()));
  EXPECT_EQ(read.problems.size(), 4u) << joined(read.problems);
  for (const ErrorText& problem : read.problems)
    EXPECT_NE(problem.where.find("part.toml:"), std::string::npos);
}

TEST(Recipe, PrintedExamplesAreValid) {
  std::string text = filled(print_recipe(Recipe()));
  text = std::regex_replace(text, std::regex(R"((^|\n)# (\[|[a-z_]+ = ))"), "$1$2");
  const RecipeRead read = parse(text);
  // All at once they contradict each other, and only in these two ways.
  EXPECT_EQ(
      joined(read.problems),
      "the tool path is given twice (shop/part.toml, [toolpath]): found file and from_contour; needed one of "
      "them; next: remove [toolpath.from_contour] or toolpath.file\n");
  EXPECT_EQ(read.recipe.part.thickness_mm, 3.0);
  EXPECT_TRUE(read.recipe.scan.initial.given);
}

TEST(Recipe, PrintedAgainIsTheSame) {
  Recipe recipe = parse(kStarred + "[toolpath.from_contour]\noffset_mm = 0.1\n").recipe;
  const std::string once = print_recipe(recipe, "shop");
  const RecipeRead again = parse(once);
  EXPECT_TRUE(again.problems.empty()) << joined(again.problems);
  EXPECT_EQ(print_recipe(again.recipe, "shop"), once);
  EXPECT_TRUE(again.recipe.toolpath.from_contour.given);
}

TEST(Recipe, PathsAreRelativeToTheRecipe) {
  const Recipe recipe =
      parse(kStarred + "[toolpath]\nfile = \"../paths/p.csv\"\n[cell]\nfile = \"/etc/cell.toml\"\n").recipe;
  EXPECT_EQ(recipe.part.cad, "shop/a.stl");
  EXPECT_EQ(recipe.toolpath.file, "paths/p.csv");
  EXPECT_EQ(recipe.cell, "/etc/cell.toml");
  EXPECT_TRUE(recipe.contour.file.empty());
}

TEST(Recipe, DefaultsAreThoseOfTheRooms) {
  const Recipe recipe;
  const double degree = std::numbers::pi / 180.0;
  const CleanOptions clean = clean_options(recipe, 0);
  EXPECT_EQ(clean.outlier_sigmas, CleanOptions().outlier_sigmas);
  EXPECT_EQ(clean.voxel_mm, CleanOptions().voxel_mm);
  const ContourOptions contour = contour_options(recipe, 0);
  EXPECT_NEAR(contour.sharp_edge_rad, ContourOptions().sharp_edge_rad, degree);
  EXPECT_NEAR(contour.angle_gap_rad, ContourOptions().angle_gap_rad, degree);
  EXPECT_EQ(contour.disc_spacings_ratio, ContourOptions().disc_spacings_ratio);
  EXPECT_EQ(contour.outsized_edge_ratio, ContourOptions().outsized_edge_ratio);
  EXPECT_EQ(contour.min_length_mm, ContourOptions().min_length_mm);
  const CorrectOptions correct = correct_options(recipe, 0);
  EXPECT_EQ(correct.max_correction_mm, CorrectOptions().max_correction_mm);
  EXPECT_NEAR(correct.max_tilt_rad, CorrectOptions().max_tilt_rad, degree);
  EXPECT_EQ(correct.max_step_ratio, CorrectOptions().max_step_ratio);
  EXPECT_EQ(correct.path_reach_mm, CorrectOptions().path_reach_mm);
}

TEST(Recipe, FromContourDefaultsAreThoseOfTheRoom) {
  const FromContourOptions read = from_contour_options(Recipe()), room;
  EXPECT_EQ(read.offset_mm, room.offset_mm);
  EXPECT_EQ(read.depth_mm, room.depth_mm);
  EXPECT_EQ(read.lateral_rad, room.lateral_rad);
  EXPECT_EQ(read.lead_rad, room.lead_rad);
  EXPECT_EQ(read.step_mm, room.step_mm);
  EXPECT_EQ(read.chord_error_mm, room.chord_error_mm);
  EXPECT_EQ(read.seam_mm, room.seam_mm);
  EXPECT_EQ(read.approach_mm, room.approach_mm);
  EXPECT_EQ(read.retract_mm, room.retract_mm);
  EXPECT_EQ(read.reversed, room.reversed);
  EXPECT_EQ(read.feed_mm_s, room.feed_mm_s);
}

TEST(Recipe, HowMuchMustBeSeenIsTheMethodsOwnUntilItIsNamed) {
  Recipe recipe;
  for (const auto& [method, seen, unseen_mm] :
       {std::tuple("surface", 0.5, 200.0), std::tuple("subdivision", 0.6, 100.0),
        std::tuple("rigid", 0.6, 100.0)}) {
    recipe.registration.method = method;
    EXPECT_EQ(registration_options(recipe, 0).min_seen_ratio, seen) << method;
    EXPECT_EQ(registration_options(recipe, 0).max_unseen_mm, unseen_mm) << method;
  }
  recipe.registration.min_seen_ratio = 0.9;
  recipe.registration.max_unseen_mm = 7.0;
  for (const char* method : {"surface", "subdivision"}) {
    recipe.registration.method = method;
    EXPECT_EQ(registration_options(recipe, 0).min_seen_ratio, 0.9);
    EXPECT_EQ(registration_options(recipe, 0).max_unseen_mm, 7.0);
  }
}

TEST(Recipe, RegistrationDefaultsAreThoseOfTheRoom) {
  const RegistrationOptions read = registration_options(Recipe(), 0), room;
  EXPECT_EQ(read.method, room.method);
  EXPECT_EQ(read.band_mm, room.band_mm);
  EXPECT_EQ(read.rigid.band_mm, room.rigid.band_mm);
  EXPECT_EQ(read.coarse.band_mm, room.coarse.band_mm);
  EXPECT_EQ(read.min_seen_ratio, room.min_seen_ratio);
  EXPECT_EQ(read.max_unseen_mm, room.max_unseen_mm);
  EXPECT_EQ(read.max_sd_mm, room.max_sd_mm);
  EXPECT_EQ(read.surface.node_spacing_mm, room.surface.node_spacing_mm);
  EXPECT_EQ(read.surface.prior.strain_ratio, room.surface.prior.strain_ratio);
  EXPECT_EQ(read.surface.prior.bend_per_mm, room.surface.prior.bend_per_mm);
  EXPECT_EQ(read.surface.offset_sd_mm, room.surface.offset_sd_mm);
  const SubdivisionIcpOptions &s = read.subdivision, &t = room.subdivision;
  EXPECT_EQ(s.subdivision.corner_radius_max_mm, t.subdivision.corner_radius_max_mm);
  EXPECT_EQ(s.subdivision.segment_length_max_mm, t.subdivision.segment_length_max_mm);
  EXPECT_EQ(s.subdivision.overlap_ratio, t.subdivision.overlap_ratio);
  EXPECT_EQ(s.match, t.match);
  EXPECT_EQ(s.stability, t.stability);
  EXPECT_EQ(s.stability_points, t.stability_points);
  EXPECT_EQ(s.stability_distance_mm, t.stability_distance_mm);
  EXPECT_EQ(s.max_iterations, t.max_iterations);
  EXPECT_EQ(s.stop_change_ratio, t.stop_change_ratio);
  EXPECT_EQ(read.projection.kind, room.projection.kind);
  EXPECT_EQ(read.projection.distance_mm, room.projection.distance_mm);
  EXPECT_EQ(read.projection.max_residual_mm, room.projection.max_residual_mm);
}

TEST(Recipe, MessagesNameWhatWhereFoundNeededNext) {
  const std::pair<std::string, std::string> cases[] = {
      {"[part]\nnumbr = \"A\"\n",
       "unknown key part.numbr (shop/part.toml:2): found the text \"A\"; needed a key that arris knows; "
       "next: did you mean part.number?"},
      {"[registration.subdivison]\nband_mm = 3.0\n",
       "unknown table [registration.subdivison] (shop/part.toml:1): found a table of that name; needed a "
       "table that arris knows; next: did you mean "
       "registration.subdivision?"},
      {"[scan]\ncad_units = \"mm\"\n",
       "unknown key scan.cad_units (shop/part.toml:2): found the text \"mm\"; needed a key that arris knows; "
       "next: did you mean part.cad_units?"},
      {"[part]\nzzzzzz = 1\n",
       "unknown key part.zzzzzz (shop/part.toml:2): found the whole number 1; needed a key that arris knows; "
       "next: arris recipe print lists every key"},
      {"part = 3\n",
       "[part] is a table, not a value (shop/part.toml:1): found the whole number 3; needed keys below "
       "[part]; next: write a line [part] and its keys below it"},
      {"[tolerance]\nmax_correction_mm = \"20\"\n",
       "tolerance.max_correction_mm has the wrong type (shop/part.toml:2): found the text \"20\"; needed a "
       "number, 0.001 to "
       "10000; next: correct it: largest move beyond the rigid motion; a path that needs more is refused"},
      {"[registration.subdivision]\nmax_iterations = 3.5\n",
       "registration.subdivision.max_iterations has the wrong type (shop/part.toml:2): found the number 3.5; "
       "needed a whole "
       "number, 1 to 10000; next: correct it: rounds of matching at most (the paper's k_max)"},
      {"[registration.subdivision]\noverlap = 0.9\n",
       "registration.subdivision.overlap is out of range (shop/part.toml:2): found 0.9; needed 0 to 0.5; "
       "next: correct it, or leave it out for its default"},
      {"[scan]\nvoxel_mm = nan\n",
       "scan.voxel_mm is not a finite number (shop/part.toml:2): found nan; needed a number, 0 to 100; next: "
       "correct it, or leave it out for its default"},
      {"[part]\nstate = \"clampd\"\n",
       "part.state has no such choice (shop/part.toml:2): found \"clampd\"; needed one of clamped, free; "
       "next: did you mean "
       "\"clamped\"?"},
      {"[scan]\nseen_from = [1, 2]\n",
       "scan.seen_from has the wrong length (shop/part.toml:2): found 2 numbers; needed 3 numbers; next: "
       "correct it, or leave it out for its default"},
      {"[scan]\nseen_from = [1, 2, \"3\"]\n",
       "scan.seen_from has the wrong type (shop/part.toml:2): found a list of 3; needed 3 numbers; next: "
       "correct it: x, y, z (mm, scan frame) of a point on the air side; tells the two sides of a flat part "
       "apart"},
      {"[contour]\naccept = 1\n",
       "contour.accept has the wrong type (shop/part.toml:2): found the whole number 1; needed a list of "
       "whole numbers, 1 or more; next: correct it: ids of the drawing's contours to use (arris contours CAD "
       "lists them); none: all, if there is one"},
      {"[contour]\naccept = [0]\n",
       "contour.accept is out of range (shop/part.toml:2): found 0; needed 1 or more; next: correct it, or "
       "leave it out for its default"},
      {"schema = 2\n",
       "schema is out of range (shop/part.toml:1): found 2; needed 1; next: correct it, or leave it out for "
       "its default"},
      {"[part]\nnumber = 1979-05-27\n",
       "part.number has the wrong type (shop/part.toml:2): found a date or time; needed a text in quotes; "
       "next: correct it: part number, printed on every result"},
      {"[part]\nnumber = \"\"\n",
       "part.number is empty (shop/part.toml:2): found \"\"; needed a text in quotes; next: fill it in: part "
       "number, "
       "printed on every result"},
  };
  for (const auto& [text, line] : cases) EXPECT_EQ(problem_of(text), line) << text;
}

TEST(Recipe, ThicknessIsNeededWhereItIsUsed) {
  const auto problem_with = [](const std::string& part, const std::string& path) {
    return problem_of("[part]\nnumber = \"A-1\"\ncad = \"a.stl\"\ncad_units = \"mm\"\n" + part +
                      "[scan]\nunits = \"mm\"\n[toolpath]\n" + path);
  };
  const std::string far = "face = \"other\"\n", missing = "the thickness of the part is missing";
  EXPECT_TRUE(problem_with("cad_is = \"mid\"\n", "").starts_with(missing));
  EXPECT_TRUE(problem_with("cad_is = \"other_face\"\n", "").starts_with(missing));
  EXPECT_TRUE(problem_with("cad_is = \"mid\"\nthickness_mm = 0.0\n", "").starts_with(missing));
  EXPECT_TRUE(problem_with("", far).starts_with(missing));
  EXPECT_EQ(problem_with("thickness_mm = 2.0\n", far), "");
  EXPECT_EQ(problem_with("cad_is = \"solid\"\n", far), "");  // it says it itself
}

TEST(Recipe, WordsOfLaterVersionsSaySo) {
  const std::pair<std::string, std::string> cases[] = {
      {"[robot]\ncontroller = \"krl\"\n", "use \"rapid\""},
  };
  for (const auto& [text, use] : cases) {
    const std::string line = problem_of(text);
    EXPECT_NE(line.find("is not in this version yet"), std::string::npos) << line;
    EXPECT_NE(line.find(use), std::string::npos) << line;
  }
}

TEST(Recipe, MissingKeysAreNamedWithTheirTable) {
  const RecipeRead read = parse("schema = 1\n");
  ASSERT_EQ(read.problems.size(), 4u);
  EXPECT_EQ(to_line(read.problems[1]),
            "part.cad is missing (shop/part.toml, [part]): found no such key; needed a file name in quotes; "
            "next: add it: mesh "
            "of the drawing "
            "(stl, ply, off)");
}

TEST(Recipe, BrokenTomlNamesTheLine) {
  const std::string line = problem_of("[part]\nnumber = \"A\ncad = 3\n");
  EXPECT_TRUE(line.starts_with("the file is no valid TOML (shop/part.toml:2): found ")) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST(Recipe, ContradictionsAreProblems) {
  EXPECT_NE(
      problem_of(kStarred + "[contour]\naccept = [1]\nreject = [1]\n").find("both accepted and rejected"),
      std::string::npos);
  EXPECT_NE(problem_of(kStarred + "[contour]\nstock_mm = 1\n").find("belongs to role"), std::string::npos);
  const std::string joint = "[registration.subdivision]\nrefine = \"ceres\"\n";
  EXPECT_NE(problem_of(kStarred + joint).find("belongs to method"), std::string::npos);
  EXPECT_EQ(problem_of(kStarred + "[registration]\nmethod = \"subdivision\"\n" + joint), "");
  const std::string matching = "[registration.subdivision]\nmatch = \"paper\"\n";
  EXPECT_NE(problem_of(kStarred + matching).find("no effect with this matching"), std::string::npos);
  for (const char* fitting : {"paper", "none"})
    EXPECT_EQ(problem_of(kStarred + matching + "stability_points = \"" + fitting + "\"\n"), "");
  EXPECT_NE(
      problem_of(kStarred + "[registration.subdivision]\nstability_points = \"paper\"\n").find("no effect"),
      std::string::npos);
  EXPECT_NE(problem_of(kStarred.substr(0, kStarred.size()) + "initial = {}\n").find("has no pose"),
            std::string::npos);
}

TEST(Recipe, ReadRecipeThrowsTheFirstProblemWithExitCodeThree) {
  const testing::TestFolder folder;
  try {
    (void)read_recipe(folder.write("bad.toml", "[part]\nnumbr = 1\n"));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(exit_code(error.fault()), 3);
    EXPECT_NE(std::string(error.what()).find("part.number"), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)read_recipe(folder.path() / "none.toml"), Error);
  EXPECT_THROW((void)read_recipe(folder.path()), Error);
}

TEST(Recipe, FixturesAreGood) {
  const std::filesystem::path fixtures = std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures";
  for (const char* name : {"example", "fe/porthole", "fe/nosecone", "fe/sheet"}) {
    const std::filesystem::path file = fixtures / name / "recipe.toml";
    const Recipe recipe = read_recipe(file);
    EXPECT_TRUE(std::filesystem::exists(recipe.part.cad)) << recipe.part.cad;
    EXPECT_TRUE(std::filesystem::exists(recipe.toolpath.file)) << recipe.toolpath.file;
  }
}

TEST(InitialPose, ReadsSixteenTwelveAndSevenNumbers) {
  const std::vector<double> twelve = {0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30};
  std::vector<double> sixteen = twelve;
  sixteen.insert(sixteen.end(), {0, 0, 0, 1});
  const double r = std::sqrt(0.5);
  const RigidMotion a = motion_from_numbers("k", twelve), b = motion_from_numbers("k", sixteen),
                    c = motion_from_numbers("k", {10, 20, 30, r, 0, 0, r});
  EXPECT_TRUE(a.isApprox(b, 1e-12));
  EXPECT_TRUE(a.isApprox(c, 1e-12));
  EXPECT_TRUE((a * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(10, 21, 30), 1e-12));
}

TEST(InitialPose, RefusesMirrorsScalesAndLooseQuaternions) {
  EXPECT_THROW((void)motion_from_numbers("k", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}), Error);
  EXPECT_THROW((void)motion_from_numbers("k", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0}), Error);
  EXPECT_THROW((void)motion_from_numbers("k", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2}), Error);
  EXPECT_THROW((void)motion_from_numbers("k", {0, 0, 0, 1, 1, 0, 0}), Error);
}

TEST(NearestName, FindsTyposAndNothingFar) {
  const std::vector<std::string> names = {"number", "cad", "cad_units", "state"};
  EXPECT_EQ(nearest_name("numebr", names), "number");
  EXPECT_EQ(nearest_name("cadunits", names), "cad_units");
  EXPECT_EQ(nearest_name("stat", names), "state");
  EXPECT_EQ(nearest_name("temperature", names), "");
}

TEST(Units, AreMillimetres) {
  EXPECT_EQ(unit_mm("mm"), 1.0);
  EXPECT_EQ(unit_mm("cm"), 10.0);
  EXPECT_EQ(unit_mm("m"), 1000.0);
  EXPECT_EQ(unit_mm("inch"), 25.4);
}

}  // namespace
}  // namespace arris
