// The real program, as a shell sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/cli/run_arris.hpp"

namespace arris {
namespace {

using testing::Ran;
using testing::run_arris;

const std::filesystem::path kExample = std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures" / "example";

/// Exactly one line, from the program.
void expect_one_line(const Ran& ran, const std::string& holds) {
  EXPECT_TRUE(ran.err.starts_with("arris: ")) << ran.err;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  EXPECT_NE(ran.err.find(holds), std::string::npos) << ran.err;
}

TEST(Program, HelpOfEveryCommandHasAnExample) {
  for (const char* command :
       {"", "run", "inspect", "batch", "map", "contours", "info", "recipe", "recipe check", "recipe print",
        "recipe new", "calibrate", "calibrate edge", "demo"}) {
    const Ran ran = run_arris(std::string(command) + " --help");
    EXPECT_EQ(ran.code, 0) << command;
    EXPECT_NE(ran.out.find("Example:\n  arris " + std::string(command)), std::string::npos) << ran.out;
    EXPECT_NE(ran.out.find("Usage: arris"), std::string::npos) << ran.out;
    EXPECT_TRUE(ran.err.empty()) << ran.err;
  }
}

TEST(Program, ListsOnlyCommandsThatExist) {
  const std::string help = run_arris("--help").out;
  for (const char* later : {"engrave", "post", "send", "station", "gpio", "archive", "trend", "study"})
    EXPECT_EQ(help.find("  " + std::string(later) + " "), std::string::npos) << later;
}

TEST(Program, VersionIsOneLine) {
  const Ran ran = run_arris("--version");
  EXPECT_EQ(ran.code, 0);
  EXPECT_TRUE(ran.out.starts_with("arris ")) << ran.out;
}

TEST(Program, UsageErrorsAreTwo) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "required"},
      {"rn x", "did you mean run?"},
      {"run x.toml --scn y", "did you mean --scan?"},
      {"run x.toml", "--scan is required"},
      {"run x.toml --scan a b", "does not take \"b\""},
      {"run --scan a", "RECIPE is required"},
      {"batch x.toml", "SCAN is required"},
      {"batch x.toml s.ply --jbs 2", "did you mean --jobs?"},
      {"map x.toml", "--scan is required"},
      {"contours x.stl --units km", "km"},
      {"contours x.stl --accept one", "--accept"},
      {"contours x.stl --out c.json", "--accept"},
      {"info", "FILE is required"},
      {"info a --threads x", "--threads"},
      {"recipe", "required"},
      {"recipe chek x", "did you mean check?"},
      {"demo --part wing", "wing"},
  };
  for (const auto& [line, holds] : cases) {
    const Ran ran = run_arris(line);
    EXPECT_EQ(ran.code, 2) << line;
    EXPECT_TRUE(ran.out.empty()) << ran.out;
    expect_one_line(ran, holds);
  }
}

TEST(Program, MissingFilesAreThreeAndLeaveNothing) {
  const testing::TestFolder folder;
  for (const char* line :
       {"run none.toml --scan s.ply", "inspect none.toml --scan s.ply", "batch none.toml s.ply",
        "map none.toml --scan s.ply", "contours none.stl", "info none.ply", "recipe check none.toml",
        "recipe print none.toml", "recipe new --cad none.stl"}) {
    const Ran ran = run_arris(line, folder.path());
    EXPECT_EQ(ran.code, 3) << line << ": " << ran.err;
    expect_one_line(ran, "none.");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Program, MissingScanIsThree) {
  const Ran ran = run_arris("run '" + (kExample / "recipe.toml").string() + "' --scan none.ply --out x");
  EXPECT_EQ(ran.code, 3) << ran.err;
  expect_one_line(ran, "none.ply");
}

TEST(Program, FullDiskIsThree) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
  const Ran ran = run_arris("recipe print > /dev/full");
  EXPECT_EQ(ran.code, 3);
  expect_one_line(ran, "No space left");
}

TEST(Program, RecipePrintPassesRecipeCheck) {
  const testing::TestFolder folder;
  const Ran printed = run_arris("recipe print recipe.toml", kExample);
  ASSERT_EQ(printed.code, 0) << printed.err;
  folder.write("full.toml", printed.out);
  for (const char* name : {"plate.stl", "contour.csv", "path.csv", "cell.toml"})
    std::filesystem::copy_file(kExample / name, folder.path() / name);
  const Ran checked = run_arris("recipe check full.toml", folder.path());
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_EQ(checked.out, "full.toml: good\n");
}

TEST(Program, RecipeCheckNamesEveryProblemAndMissingFiles) {
  const testing::TestFolder folder;
  folder.write("r.toml",
               "[part]\nnumber = \"A\"\ncad = \"no.stl\"\ncad_units = \"mm\"\nstat = \"free\"\n[scan]\nunits "
               "= \"km\"\n");
  const Ran ran = run_arris("recipe check r.toml", folder.path());
  EXPECT_EQ(ran.code, 3);
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 3) << ran.err;
  for (const char* part : {"r.toml:5", "part.state", "r.toml:7", "no.stl"})
    EXPECT_NE(ran.err.find(part), std::string::npos) << part << "\n" << ran.err;
  const Ran json = run_arris("recipe check r.toml --json", folder.path());
  EXPECT_EQ(json.code, 3);
  EXPECT_NE(json.out.find("\"good\": false"), std::string::npos) << json.out;
}

/// The example's drawing, recipe and path in a folder of their own.
void put_example(const std::filesystem::path& folder) {
  for (const char* name : {"recipe.toml", "plate.stl", "contour.csv", "path.csv", "cell.toml"})
    std::filesystem::copy_file(kExample / name, folder / name);
}

/// The example's recipe with one text in it, or in a file beside it, in the place of another.
void spoil(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::string text = testing::text_of(file);
  ASSERT_NE(text.find(from), std::string::npos) << file << ": " << from;
  text.replace(text.find(from), from.size(), to);
  std::ofstream(file, std::ios::binary) << text;
}

/// What is wrong in a drawing or a path is named without a scan, in the words of the run that would refuse
/// it.
TEST(Program, RecipeCheckSaysWhatARunWouldRefuse) {
  struct Case {
    const char *file, *from, *to, *holds;
  };
  const Case cases[] = {
      {"recipe.toml", "file = \"contour.csv\"", "", "several contours and none accepted"},
      {"recipe.toml", "file = \"contour.csv\"", "accept = [77]", "names a contour that the CAD has not"},
      {"recipe.toml", "cad_units = \"mm\"", "cad_units = \"m\"", "lies on no edge of the CAD"},
      {"path.csv", "closed\n", "closed\nnan,0,0,0,0,1,1,1\n", "not a finite number in column x"},
      {"path.csv", "", "", "belongs nowhere on the CAD"},
      {"plate.stl", "", "", "empty"},
  };
  for (const Case& one : cases) {
    const testing::TestFolder folder;
    put_example(folder.path());
    if (*one.from != '\0')
      spoil(folder.path() / one.file, one.from, one.to);
    else
      folder.write(one.file, std::string(one.file) == "plate.stl" ? "" : "x,y,z,nx,ny,nz\n0,0,900,0,0,1\n");
    const Ran checked = run_arris("recipe check recipe.toml", folder.path());
    const Ran ran =
        run_arris("run recipe.toml --out r --scan '" + (kExample / "scan.ply").string() + "'", folder.path());
    EXPECT_EQ(checked.code, 3) << one.holds << checked.out;
    expect_one_line(checked, one.holds);
    EXPECT_EQ(checked.err, ran.err);
  }
}

TEST(Program, RecipeCheckNamesWhatIsWrongInDrawingPathAndCell) {
  const testing::TestFolder folder;
  put_example(folder.path());
  spoil(folder.path() / "recipe.toml", "file = \"contour.csv\"", "");
  spoil(folder.path() / "path.csv", "closed\n", "closed\nnan,0,0,0,0,1,1,1\n");
  spoil(folder.path() / "cell.toml", "[frames]", "[nonsense]\n[frames]");
  const Ran ran = run_arris("recipe check recipe.toml", folder.path());
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 3) << ran.err;
  for (const char* part : {"several contours", "column x", "nonsense"})
    EXPECT_NE(ran.err.find(part), std::string::npos) << part << "\n" << ran.err;
}

TEST(Program, RecipeCheckSaysThatWithoutAPathThereIsInspectAlone) {
  const testing::TestFolder folder;
  put_example(folder.path());
  spoil(folder.path() / "recipe.toml", "file = \"path.csv\"", "");
  const Ran ran = run_arris("recipe check recipe.toml", folder.path());
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.out.find("good, for arris inspect alone"), std::string::npos) << ran.out;
}

TEST(Program, RecipeNewIsAGoodRecipe) {
  const testing::TestFolder folder;
  const std::string cad = (kExample / "plate.stl").string(), path = (kExample / "path.csv").string();
  const Ran ran = run_arris("recipe new --cad '" + cad + "' --path '" + path + "' --part A-1 --out new.toml",
                            folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Ran several = run_arris("recipe check new.toml", folder.path());
  EXPECT_EQ(several.code, 3) << "the plate has four contours, and the tool follows one";
  expect_one_line(several, "several contours");
  const std::string accept = "\n[contour]\naccept = [2]\n";
  folder.write("full.toml", testing::text_of(folder.path() / "new.toml") + accept);
  const Ran checked = run_arris("recipe check full.toml", folder.path());
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_EQ(run_arris("recipe new --cad '" + cad + "' --out new.toml", folder.path()).code, 3)
      << "it replaced a file";
  const Ran printed = run_arris("recipe new --cad '" + cad + "'", folder.path());
  folder.write("second.toml", printed.out + accept);
  EXPECT_EQ(run_arris("recipe check second.toml", folder.path()).code, 0) << printed.out;
}

TEST(Program, CellPrintAndCheck) {
  const testing::TestFolder folder;
  const Ran printed = run_arris("recipe print --cell cell.toml", kExample);
  ASSERT_EQ(printed.code, 0) << printed.err;
  folder.write("cell.toml", printed.out);
  EXPECT_EQ(run_arris("recipe check --cell cell.toml", folder.path()).code, 0);
  folder.write("cell.toml", "[frames]\n");
  EXPECT_EQ(run_arris("recipe check --cell cell.toml", folder.path()).code, 3);
}

TEST(Program, ContoursListsDrawsAndChooses) {
  const testing::TestFolder folder;
  const std::string cad = "'" + (kExample / "plate.stl").string() + "'";
  const Ran ran = run_arris("contours " + cad + " --accept 1 --out c.json --png c.png", folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.out.find("closed"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("accept"), std::string::npos) << ran.out;
  EXPECT_EQ(testing::text_of(folder.path() / "c.png").substr(1, 3), "PNG");
  EXPECT_NE(testing::text_of(folder.path() / "c.json").find("\"role\": \"accept\""), std::string::npos);
  const Ran json = run_arris("contours " + cad + " --json", folder.path());
  EXPECT_NE(json.out.find("\"length_mm\""), std::string::npos) << json.out;
  const Ran none = run_arris("contours " + cad + " --accept 99 --out d.json", folder.path());
  EXPECT_EQ(none.code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "d.json"));
}

TEST(Program, ContoursOverwritesNothingButItsOwn) {
  const testing::TestFolder folder;
  put_example(folder.path());
  std::filesystem::create_symlink("plate.stl", folder.path() / "link.stl");
  folder.write("notes.json", "{\"mine\": 1}");
  const std::string begin = "contours plate.stl --recipe recipe.toml --accept 1 ";
  const std::pair<const char*, const char*> cases[] = {
      {"--out plate.stl", "plate.stl"},
      {"--out link.stl", "link.stl"},
      {"--out recipe.toml", "recipe.toml"},
      {"--out path.csv", "path.csv"},
      {"--out notes.json", "notes.json"},
      {"--png plate.stl", "plate.stl"},
      {"--png ./recipe.toml", "recipe.toml"},
      {"--png notes.json", "notes.json"},
      {"--out new.json --png new.json", "new.json"},
  };
  for (const auto& [options, file] : cases) {
    const std::string before = testing::text_of(folder.path() / file);
    const Ran ran = run_arris(begin + options, folder.path());
    EXPECT_EQ(ran.code, 3) << options;
    expect_one_line(ran, file);
    for (const char* part : {"(", "found ", "needed ", "next: "})
      EXPECT_NE(ran.err.find(part), std::string::npos) << part << ran.err;
    EXPECT_TRUE(ran.out.empty()) << ran.out;
    EXPECT_EQ(testing::text_of(folder.path() / file), before) << options;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "new.json"));
  for (int time = 0; time < 2; ++time)
    EXPECT_EQ(run_arris(begin + "--out c.json --png c.png", folder.path()).code, 0) << "a former one may go";
  const Ran scan = run_arris(
      "contours '" + (kExample / "scan.ply").string() + "' --recipe recipe.toml --accept 1 --out plate.stl",
      folder.path());
  EXPECT_EQ(scan.code, 3);
  expect_one_line(scan, "drawing");
}

TEST(Program, FullDiskOfTheSummaryLeavesNoFolder) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
  const testing::TestFolder folder;
  for (const char* json : {"", "--json "}) {
    const Ran ran = run_arris("run '" + (kExample / "recipe.toml").string() + "' --scan '" +
                                  (kExample / "scan.ply").string() + "' --out r " + json + "> /dev/full",
                              folder.path());
    EXPECT_EQ(ran.code, 3);
    for (const char* part : {"(stdout)", "found No space left", "needed ", "next: "})
      expect_one_line(ran, part);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "a hidden folder counts";
  }
}

TEST(Program, InfoSaysWhatAFileHolds) {
  const std::string scan = "'" + (kExample / "scan.ply").string() + "'";
  const Ran ran = run_arris("info " + scan);
  ASSERT_EQ(ran.code, 0) << ran.err;
  for (const char* part : {"format", "points", "sha256", "extent", "unit"})
    EXPECT_NE(ran.out.find(std::string(part) + " "), std::string::npos) << ran.out;
  const Ran json = run_arris("info --json " + scan);
  EXPECT_NE(json.out.find("\"has_normals\": true"), std::string::npos) << json.out;
}

TEST(Program, DemoReplacesItsOwnFolderAndNoOther) {
  const testing::TestFolder folder;
  for (int time = 0; time < 2; ++time) {
    const Ran ran = run_arris("demo --out d", folder.path());
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("report.html"), std::string::npos) << ran.out;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "d" / "result" / "report.html"));
  }
  folder.write("mine/work.txt", "mine");
  const Ran refused = run_arris("demo --out mine", folder.path());
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(testing::text_of(folder.path() / "mine" / "work.txt"), "mine");
}

/// Runs the example's main job and sends it a signal after a while; the exit code.
int interrupted_after(double seconds, const char* signal, const std::filesystem::path& folder) {
  const std::string job = "run '" + (kExample / "recipe.toml").string() + "' --scan '" +
                          (kExample / "scan.ply").string() + "' --out r & sleep " + std::to_string(seconds) +
                          "; kill -" + signal + " $!; wait $!";
  return run_arris(job, folder).code;
}

TEST(Program, InterruptedRunLeavesNothingHalfWritten) {
  int heard = 0;
  for (const char* signal : {"INT", "TERM"})
    for (double seconds = 0.01; heard < 2; seconds *= 1.5) {
      const testing::TestFolder folder;
      const int code = interrupted_after(seconds, signal, folder.path());
      if (code == 0 && seconds > 0.5) break;  // done before the signal came
      if (code != 130) continue;              // before the program listened: a shell's jobs are deaf to INT
      ++heard;
      EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << signal << " after " << seconds << " s";
    }
  EXPECT_GT(heard, 0);
}

TEST(Program, ReaderThatLeavesEarlyIsNoError) {
  const Ran ran = run_arris("recipe print | head -1");
  EXPECT_EQ(std::count(ran.out.begin(), ran.out.end(), '\n'), 1) << ran.out;
  EXPECT_TRUE(ran.err.empty()) << ran.err;
}

}  // namespace
}  // namespace arris
