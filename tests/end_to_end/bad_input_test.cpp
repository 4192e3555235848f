// Bad input: the right exit code, one line that names what is wrong, and nothing left on the disk.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <regex>

#include "fixtures/synthetic/analytic_part.hpp"
#include "tests/end_to_end/job.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;
using synthetic::SyntheticScan;
using testing::Job;
using testing::Ran;
using testing::text_of;

SyntheticScan sheet_scan() {
  return testing::fe_scan("sheet", testing::usual_options("sheet"), 51);
}

SyntheticScan plate_scan() {
  synthetic::ScanOptions options;
  options.band_mm = 0.0;
  options.points = 8000;
  return synthetic::sample_scan(synthetic::PlatePart(synthetic::asymmetric_plate()), options, 52);
}

void put_scaled(const Job& job, double factor) {
  SyntheticScan scan = sheet_scan();
  for (Vector3d& p : scan.points_mm) p *= factor;
  job.put_scan("scan.ply", scan);
}

/// Copies a good scan, with its bytes changed.
void put_changed(const Job& job, const std::function<std::string(std::string)>& change) {
  job.put_scan("scan.ply", sheet_scan());
  job.put("scan.ply", change(text_of(job.file("scan.ply"))));
}

/// Replaces the first coordinate of every n-th point by a value that is no number.
void put_with_nan(const Job& job, std::size_t every, double value) {
  SyntheticScan scan = sheet_scan();
  for (std::size_t i = 0; i < scan.points_mm.size(); i += every) scan.points_mm[i].x() = value;
  job.put_scan("scan.ply", scan);
}

/// Turns every triangle of a binary STL inside out.
void invert_stl(const Job& job, const std::string& name) {
  std::string bytes = text_of(job.file(name));
  for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50)
    std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(at) + 24,
                     bytes.begin() + static_cast<std::ptrdiff_t>(at) + 36,
                     bytes.begin() + static_cast<std::ptrdiff_t>(at) + 36);
  job.put(name, bytes);
}

/// Rewrites the coordinates of a CSV, moved; comments and header stay.
void move_csv(const Job& job, const std::string& name, const Vector3d& shift_mm) {
  const testing::Table table = testing::read_table(job.file(name));
  std::string text = table.comment + "\n" + table.header + "\n";
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const Vector3d p_mm = table.tip_mm(row) + shift_mm;
    text += std::to_string(p_mm.x()) + "," + std::to_string(p_mm.y()) + "," + std::to_string(p_mm.z());
    for (std::size_t k = 3; k < table.rows[row].size(); ++k) text += "," + table.rows[row][k];
    text += "\n";
  }
  job.put(name, text);
}

Vector3d on_sphere(int ring, int sector, int rings, int sectors) {
  const double polar_rad = 3.14159265358979 * ring / rings,
               turn_rad = 2.0 * 3.14159265358979 * sector / sectors;
  return 200.0 * Vector3d(std::sin(polar_rad) * std::cos(turn_rad), std::sin(polar_rad) * std::sin(turn_rad),
                          std::cos(polar_rad));
}

/// A closed smooth sphere as ASCII STL, outside out.
std::string sphere_stl() {
  constexpr int kRings = 48, kSectors = 96;
  std::string text = "solid sphere\n";
  const auto triangle = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    if ((b - a).cross(c - a).norm() < 1e-6) return;
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vector3d& p : {a, b, c}) {
      char line[120];
      std::snprintf(line, sizeof line, "vertex %.5f %.5f %.5f\n", p.x(), p.y(), p.z());
      text += line;
    }
    text += "endloop\nendfacet\n";
  };
  for (int r = 0; r < kRings; ++r)
    for (int s = 0; s < kSectors; ++s) {
      const auto at = [&](int ring, int sector) {
        return on_sphere(ring, sector % kSectors, kRings, kSectors);
      };
      triangle(at(r, s), at(r + 1, s), at(r + 1, s + 1));
      triangle(at(r, s), at(r + 1, s + 1), at(r, s + 1));
    }
  return text + "endsolid sphere\n";
}

/// One way to get it wrong. `make` spoils a good sheet job that has no scan yet; `holds` must stand in the
/// line.
struct Bad {
  std::string name;
  std::function<void(const Job&)> make;
  std::vector<std::string> holds;
  std::string part = "fe/sheet";
  std::string command = "run recipe.toml --scan scan.ply --out out";
};
std::ostream& operator<<(std::ostream& out, const Bad& bad) {
  return out << bad.name;
}

/// The case with a good scan beside it.
Bad recipe_case(const std::string& name, const std::function<void(const Job&)>& make,
                const std::vector<std::string>& holds) {
  return {name,
          [make](const Job& job) {
            job.put_scan("scan.ply", sheet_scan());
            make(job);
          },
          holds};
}

std::vector<Bad> bad_scans() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInf = std::numeric_limits<double>::infinity();
  return {
      {"MissingScan", [](const Job&) {}, {"scan.ply"}},
      {"EmptyScan", [](const Job& job) { job.put("scan.ply", ""); }, {"scan.ply", "empty"}},
      {"ScanCutShort",
       [](const Job& job) {
         put_changed(job, [](const std::string& all) { return all.substr(0, all.size() / 2); });
       },
       {"scan.ply", "3000"}},
      {"ScanCutInItsHeader",
       [](const Job& job) { put_changed(job, [](const std::string& all) { return all.substr(0, 90); }); },
       {"scan.ply"}},
      {"StlNamedPly",
       [](const Job& job) { job.put("scan.ply", text_of(job.file("cad.stl"))); },
       {"scan.ply"}},
      {"PictureNamedPly",
       [](const Job& job) { job.put("scan.ply", "\x89PNG\r\n\x1a\n" + std::string(400, '\x07')); },
       {"scan.ply"}},
      {"ScanIsAFolder", [](const Job& job) { job.put("scan.ply/x", ""); }, {"scan.ply"}},
      {"AllPointsNan", [=](const Job& job) { put_with_nan(job, 1, kNan); }, {"3000"}},
      {"AllPointsInfinite", [=](const Job& job) { put_with_nan(job, 1, kInf); }, {"3000"}},
      {"TooFewPoints",
       [](const Job& job) {
         SyntheticScan scan = sheet_scan();
         scan.points_mm.resize(12);
         scan.normals.resize(12);
         job.put_scan("scan.ply", scan);
       },
       {"scan.ply", "12", "30"}},
      {"OnePoint",
       [](const Job& job) {
         SyntheticScan scan = sheet_scan();
         scan.points_mm.resize(1);
         scan.normals.resize(1);
         job.put_scan("scan.ply", scan);
       },
       {"scan.ply", "1", "30"}},
      {"ScanInMetres", [](const Job& job) { put_scaled(job, 0.001); }, {"scan.ply", "unit", "1000"}},
      {"ScanInInches", [](const Job& job) { put_scaled(job, 1.0 / 25.4); }, {"scan.ply", "unit", "25.4"}},
      {"MirroredScan",
       [](const Job& job) {
         SyntheticScan scan = plate_scan();
         for (auto* list : {&scan.points_mm, &scan.normals})
           for (Vector3d& v : *list) v.y() = -v.y();
         job.put_scan("scan.ply", scan);
       },
       {"scan.ply", "mirror"},
       "example"},
      {"NoPointsInTheBand",
       [](const Job& job) {
         job.put_scan("scan.ply", sheet_scan());
         job.replace("recipe.toml", "[scan]",
                     "[scan]\ninitial = { scan_from_cad = [9000, 0, 0, 1, 0, 0, 0], within_deg = 30 }");
       },
       {"scan.ply", "band"}},
  };
}

std::vector<Bad> bad_drawings() {
  return {
      recipe_case("InvertedCad", [](const Job& job) { invert_stl(job, "cad.stl"); }, {"cad.stl", "inverted"}),
      recipe_case("CadWithoutContour",
                  [](const Job& job) {
                    job.put("cad.stl", sphere_stl());
                    job.replace("recipe.toml", "file = \"contour.csv\"\n", "");
                  },
                  {"cad.stl", "no contour"}),
      recipe_case("SeveralContoursNoneAccepted",
                  [](const Job& job) { job.replace("recipe.toml", "file = \"contour.csv\"\n", ""); },
                  {"cad.stl", "several contours", "contour.accept"}),
      recipe_case("MissingCad", [](const Job& job) { std::filesystem::remove(job.file("cad.stl")); },
                  {"cad.stl"}),
      recipe_case("EmptyCad", [](const Job& job) { job.put("cad.stl", ""); }, {"cad.stl", "empty"}),
      recipe_case("CadCutShort",
                  [](const Job& job) { job.put("cad.stl", text_of(job.file("cad.stl")).substr(0, 5000)); },
                  {"cad.stl"}),
      recipe_case("ContourOffTheCad",
                  [](const Job& job) {
                    move_csv(job, "contour.csv", {20.0, 0.0, 0.0});
                  },
                  {"contour.csv", "no edge"}),
      recipe_case("PathThatBelongsNowhere",
                  [](const Job& job) {
                    move_csv(job, "path.csv", {0.0, 0.0, 900.0});
                  },
                  {"path.csv"}),
      recipe_case("PathOfAnotherPart",
                  [](const Job& job) { job.put("path.csv", text_of(Job("fe/nosecone").file("path.csv"))); },
                  {"path.csv"}),
      recipe_case("MissingPath", [](const Job& job) { std::filesystem::remove(job.file("path.csv")); },
                  {"path.csv"}),
      recipe_case("PathWithoutAxes", [](const Job& job) { job.put("path.csv", "x,y,z\n1,2,3\n"); },
                  {"path.csv", "nx"}),
      recipe_case("PathThatIsNotANumber",
                  [](const Job& job) { job.put("path.csv", "x,y,z,nx,ny,nz\n1,2,3,0,0,1\n1,2,oh,0,0,1\n"); },
                  {"path.csv", "3", "oh"}),
      recipe_case("PathThatIsNotFinite",
                  [](const Job& job) { job.put("path.csv", "x,y,z,nx,ny,nz\n1,2,nan,0,0,1\n"); },
                  {"path.csv", "line 2", "nan"}),
      recipe_case("PathWithoutRows", [](const Job& job) { job.put("path.csv", "x,y,z,nx,ny,nz\n"); },
                  {"path.csv", "no rows"}),
      recipe_case(
          "ContourThatTheCadHasNot",
          [](const Job& job) { job.replace("recipe.toml", "file = \"contour.csv\"\n", "accept = [77]\n"); },
          {"cad.stl", "77"}),
  };
}

std::vector<Bad> bad_recipes() {
  const auto swap = [](const std::string& from, const std::string& to) {
    return [=](const Job& job) { job.replace("recipe.toml", from, to); };
  };
  return {
      recipe_case("UnknownKey", swap("[scan]\n", "[scan]\ncolour = \"red\"\n"), {"recipe.toml", "colour"}),
      recipe_case("MisspeltKey", swap("thickness_mm", "thicknes_mm"),
                  {"recipe.toml", "thicknes_mm", "thickness_mm"}),
      recipe_case("MisspeltTable", swap("[tolerance]", "[tolerances]"),
                  {"recipe.toml", "tolerances", "tolerance"}),
      recipe_case("ScanUnitMissing", swap("[scan]\nunits = \"mm\"\n", "[scan]\n"), {"recipe.toml", "units"}),
      recipe_case("CadUnitMissing", swap("cad_units = \"mm\"\n", ""), {"recipe.toml", "cad_units"}),
      recipe_case("UnitUnknown", swap("[scan]\nunits = \"mm\"", "[scan]\nunits = \"furlong\""),
                  {"recipe.toml", "furlong", "inch"}),
      recipe_case("ValueOutOfBounds", swap("max_correction_mm = 20.0", "max_correction_mm = -1.0"),
                  {"recipe.toml", "max_correction_mm", "-1"}),
      recipe_case("SchemaOfLater", swap("schema = 1", "schema = 2"), {"recipe.toml", "schema", "2"}),
      recipe_case("MethodUnknown", swap("[tolerance]", "[registration]\nmethod = \"guess\"\n[tolerance]"),
                  {"recipe.toml", "guess", "surface"}),
      recipe_case("WrongType", swap("max_correction_mm = 20.0", "max_correction_mm = \"20\""),
                  {"recipe.toml", "max_correction_mm", "20"}),
      recipe_case("NoToolPath", swap("file = \"path.csv\"", ""), {"no tool path", "arris inspect"}),
      recipe_case("RecipeThatIsNoToml", swap("[scan]", "[scan"), {"recipe.toml"}),
      recipe_case("EmptyRecipe", [](const Job& job) { job.put("recipe.toml", ""); }, {"recipe.toml"}),
      recipe_case("ProcessOfLater", swap("process = \"deburr\"", "process = \"mill\""),
                  {"recipe.toml", "mill", "deburr"}),
      recipe_case("CellCutShort",
                  [](const Job& job) { job.put("cell.toml", text_of(job.file("cell.toml")).substr(0, 110)); },
                  {"cell.toml"}),
      recipe_case("CellWithoutFrame", [](const Job& job) { job.put("cell.toml", "[frames]\n"); },
                  {"cell.toml", "robot_from_scan"}),
      recipe_case("MissingCell", [](const Job& job) { std::filesystem::remove(job.file("cell.toml")); },
                  {"cell.toml"}),
      recipe_case(
          "PartBeyondTheRobotsReach",
          [](const Job& job) { job.replace("cell.toml", "850.0, 0.0, 400.0", "85000.0, 0.0, 400.0"); },
          {"reach"}),
      recipe_case("OperatorsChoiceMissing", swap("validation = \"auto\"", "validation = \"operator\""),
                  {"--contours"}),
  };
}

std::vector<Bad> bad_outputs() {
  Bad parent = recipe_case("OutputsParentMissing", [](const Job&) {}, {"nowhere"});
  parent.command = "run recipe.toml --scan scan.ply --out nowhere/deeper/out";
  // A file may grow to 40 blocks of 1 KiB, and writing more fails instead of ending the program.
  Bad full = recipe_case("FullDisk", [](const Job&) {}, {"written"});
  full.command =
      "--version >/dev/null; trap '' XFSZ; ulimit -f 40; '" ARRIS_BINARY_DIR "/cli/arris' " + full.command;
  return {
      recipe_case("OutputExists", [](const Job& job) { job.put("out/mine.txt", "mine"); }, {"out", "exists"}),
      recipe_case("OutputIsAFile", [](const Job& job) { job.put("out", "mine"); }, {"out", "exists"}),
      parent,
      full,
  };
}

/// "arris: what (where): found ..; needed ..; next: ..", none of them empty.
const std::regex kFiveParts(R"(arris: [^(]\S.* \(\S.*\): found \S.*; needed \S.*; next: \S.*\n)");

class BadInput : public ::testing::TestWithParam<Bad> {};

TEST_P(BadInput, IsThreeInOneLineAndLeavesNothing) {
  const Bad& bad = GetParam();
  const Job job(bad.part);
  bad.make(job);
  const std::set<std::string> before = job.names();
  const Ran ran = job.arris(bad.command);
  EXPECT_EQ(ran.code, 3) << ran.out;
  EXPECT_TRUE(ran.err.starts_with("arris: ")) << ran.err;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  EXPECT_TRUE(ran.out.empty()) << ran.out;
  for (const std::string& part : bad.holds)
    EXPECT_NE(ran.err.find(part), std::string::npos) << part << ": " << ran.err;
  EXPECT_TRUE(std::regex_match(ran.err, kFiveParts)) << ran.err;
  EXPECT_EQ(job.names(), before);
  if (before.contains("out") && std::filesystem::is_directory(job.file("out"))) {
    EXPECT_EQ(job.names("out"), std::set<std::string>{"mine.txt"});
  }
}

std::string name_of(const ::testing::TestParamInfo<Bad>& one) {
  return one.param.name;
}
INSTANTIATE_TEST_SUITE_P(Scan, BadInput, ::testing::ValuesIn(bad_scans()), name_of);
INSTANTIATE_TEST_SUITE_P(Drawing, BadInput, ::testing::ValuesIn(bad_drawings()), name_of);
INSTANTIATE_TEST_SUITE_P(Recipe, BadInput, ::testing::ValuesIn(bad_recipes()), name_of);
INSTANTIATE_TEST_SUITE_P(Output, BadInput, ::testing::ValuesIn(bad_outputs()), name_of);

/// Some points that are no numbers are dropped and counted; the rest is worth a result.
TEST(SomeNan, IsCountedAndTheRestIsUsed) {
  const Job job("fe/sheet");
  put_with_nan(job, 50, std::numeric_limits<double>::quiet_NaN());
  const Ran ran = job.run("scan.ply", "out");
  ASSERT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.code << ran.err;
  const auto result = nlohmann::json::parse(text_of(job.file("out/result.json")));
  EXPECT_EQ(result.at("acquisition").at("points_nonfinite").get<int>(), 60);
}

/// The asymmetric plate's own scan is good: what refuses its mirror image is the mirroring.
TEST(Mirrored, TheSameScanUnmirroredIsGood) {
  const Job job("example");
  job.put_scan("scan.ply", plate_scan());
  const Ran ran = job.run("scan.ply", "out");
  EXPECT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.code << ran.out << ran.err;
}

}  // namespace
}  // namespace arris
