// Each rule is fed what it must refuse, and what it must let pass.
#include "tests/arch/rules.hpp"

#include <gtest/gtest.h>

namespace arris::arch {
namespace {

SourceFile including(const std::string& path, const std::string& target) {
  return {path, "#include \"" + target + "\"\n"};
}

TEST(SourceText, LosesCommentsAndLiteralsButNoLine) {
  const std::string text = "a // b\n/* c\n d */ e \"f // g\" 'h' 1'000 R\"x(i\"j)x\" k\n";
  EXPECT_EQ(without_comments(text, false), "a     \n    \n      e \"      \" ' ' 1'000 R\"       \" k\n");
  EXPECT_EQ(without_comments(text, true), "a     \n    \n      e \"f // g\" 'h' 1'000 R\"x(i\"j)x\" k\n");
}

TEST(SourceText, FindsIncludesWithTheirLines) {
  const SourceFile file{"cli/a.cpp",
                        "// #include \"no.hpp\"\n#include <vector>\n  # include \"cli/b.hpp\"\n"};
  const std::vector<Include> found = includes_of(file);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].target, "vector");
  EXPECT_FALSE(found[0].quoted);
  EXPECT_EQ(found[1].target, "cli/b.hpp");
  EXPECT_EQ(found[1].line, 3);
}

TEST(Doors, KnowTheRooms) {
  EXPECT_EQ(room_of("acquisition/types/error.hpp"), "types");
  EXPECT_EQ(room_of("acquisition/geometry/nearest.cpp"), "geometry");
  EXPECT_EQ(room_of("acquisition/bridge/pcl.hpp"), "bridge");
  EXPECT_EQ(room_of("acquisition/files/read_ply.cpp"), "acquisition");
  EXPECT_EQ(room_of("acquisition/clean.hpp"), "acquisition");
  EXPECT_EQ(room_of("toolpath/robot/program.hpp"), "toolpath");
  EXPECT_EQ(room_of("vector"), "");
  EXPECT_EQ(room_of("docs/page.md"), "");
}

TEST(Doors, RefuseEveryStepBackAndEveryDetour) {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"acquisition/types/a.hpp", "acquisition/geometry/nearest.hpp"},
           {"acquisition/geometry/a.cpp", "acquisition/clean.hpp"},
           {"acquisition/geometry/a.cpp", "acquisition/bridge/pcl.hpp"},
           {"acquisition/bridge/a.cpp", "acquisition/geometry/nearest.hpp"},
           {"acquisition/clean.cpp", "registration/rigid_icp.hpp"},
           {"acquisition/files/a.cpp", "fixtures/synthetic/scan.hpp"},
           {"registration/a.cpp", "acquisition/clean.hpp"},
           {"registration/a.cpp", "acquisition/files/read_scan.hpp"},
           {"registration/a.cpp", "toolpath/toolpath.hpp"},
           {"toolpath/a.cpp", "report/run_record.hpp"},
           {"toolpath/formats/a.cpp", "acquisition/files/read_scan.hpp"},
           {"toolpath/a.cpp", "acquisition/bridge/pcl.hpp"},
           {"report/a.cpp", "cli/recipe.hpp"},
           {"report/a.cpp", "acquisition/clean.hpp"},
           {"fixtures/a.cpp", "acquisition/geometry/nearest.hpp"},
           {"fixtures/a.cpp", "registration/rigid_icp.hpp"},
           {"cli/a.cpp", "tests/support/a.hpp"}})
    EXPECT_EQ(check_doors(including(from, to)).size(), 1U) << from << " -> " << to;
}

TEST(Doors, LetTheDataWalk) {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"acquisition/types/a.hpp", "acquisition/types/b.hpp"},
           {"acquisition/geometry/a.hpp", "acquisition/types/b.hpp"},
           {"acquisition/a.hpp", "acquisition/geometry/b.hpp"},
           {"acquisition/files/a.cpp", "acquisition/bridge/b.hpp"},
           {"registration/a.hpp", "acquisition/geometry/b.hpp"},
           {"registration/a.cpp", "acquisition/bridge/b.hpp"},
           {"toolpath/robot/a.hpp", "registration/b.hpp"},
           {"report/a.hpp", "toolpath/b.hpp"},
           {"fixtures/synthetic/a.cpp", "acquisition/types/b.hpp"},
           {"cli/a.cpp", "report/b.hpp"},
           {"tests/laws/a.cpp", "cli/b.hpp"}})
    EXPECT_EQ(to_text(check_doors(including(from, to))), "");
}

TEST(Doors, KeepTheBridgeOutOfHeaders) {
  EXPECT_EQ(check_doors(including("registration/a.hpp", "acquisition/bridge/pcl.hpp")).size(), 1U);
  EXPECT_EQ(check_doors(including("acquisition/a.hpp", "acquisition/bridge/pcl.hpp")).size(), 1U);
}

TEST(Doors, WantPathsFromTheRoot) {
  EXPECT_EQ(check_doors(including("report/a.cpp", "a.hpp")).size(), 1U);
  EXPECT_EQ(check_doors(including("report/a.cpp", "../cli/a.hpp")).size(), 1U);
  EXPECT_TRUE(check_doors({"report/a.cpp", "#include <vector>\n"}).empty());
}

TEST(Quarantine, RefusesThirdPartyInHeaders) {
  for (const std::string header : {"pcl/point_types.h", "ceres/ceres.h",
                                   "opencv2/core.hpp",  "flann/flann.hpp",
                                   "gpiod.h",           "gpiod.hpp",
                                   "boost/asio.hpp",    "vtkSmartPointer.h",
                                   "embree3/rtcore.h",  "tbb/parallel_for.h",
                                   "oneapi/tbb.h",      "tbb.h",
                                   "nlohmann/json.hpp", "nlohmann/json_fwd.hpp",
                                   "fmt/format.h",      "cairo.h",
                                   "cairo/cairo.h",     "CLI/CLI.hpp",
                                   "toml++/toml.h",     "openssl/evp.h"}) {
    EXPECT_EQ(check_quarantine({"registration/a.hpp", "#include <" + header + ">\n"}).size(), 1U) << header;
    EXPECT_EQ(check_quarantine({"tests/support/a.hpp", "#include \"" + header + "\"\n"}).size(), 1U)
        << header;
    EXPECT_TRUE(check_quarantine({"registration/a.cpp", "#include <" + header + ">\n"}).empty()) << header;
    EXPECT_TRUE(check_quarantine({"acquisition/bridge/a.hpp", "#include <" + header + ">\n"}).empty())
        << header;
  }
  EXPECT_TRUE(check_quarantine({"registration/a.hpp", "#include <Eigen/Core>\n#include <vector>\n"}).empty());
}

TEST(Silence, RefusesPrintingAndExiting) {
  for (const std::string line :
       {"std::cout << 1;", "std::cerr << 1;", "std::clog << 1;", "printf(\"a\");", "std::printf (\"a\");",
        "std::fprintf(stderr, \"a\");", "fprintf( stdout, \"a\");", "vprintf(a, b);", "std::puts(\"a\");",
        "putchar('a');", "fputs(text, stderr);", "perror(\"a\");", "fmt::print(\"a\");", "std::exit(1);",
        "exit(1);", "_exit(1);", "std::quick_exit(1);", "std::abort();", "std::terminate();"}) {
    EXPECT_EQ(check_silence({"registration/a.cpp", "void f() {\n" + line + "\n}\n"}).size(), 1U) << line;
    EXPECT_EQ(check_silence({"tests/support/a.cpp", line}).size(), 1U) << line;
    EXPECT_TRUE(check_silence({"cli/console.cpp", line}).empty()) << line;
    EXPECT_TRUE(check_silence({"fixtures/make.cpp", "int main() {\n" + line + "\n}\n"}).empty()) << line;
    EXPECT_EQ(check_silence({"report/a.cpp", "int main() {\n" + line + "\n}\n"}).size(), 1U) << line;
  }
}

TEST(Silence, KnowsWhatOnlyLooksLoud) {
  for (const std::string line :
       {"// std::cout << 1;", "const char* a = \"printf(\";", "std::snprintf(a, 3, \"b\");",
        "fprintf(file, \"a\");", "int code = exit_code(fault);", "std::ofstream out;", "on_exit_done();",
        "/* exit(1) */"})
    EXPECT_EQ(to_text(check_silence({"registration/a.cpp", line})), "") << line;
}

TEST(Length, EndsAtFiveHundredLines) {
  std::string text;
  for (int i = 0; i < 500; ++i) text += "x\n";
  EXPECT_TRUE(check_length({"cli/a.cpp", text}).empty());
  EXPECT_EQ(check_length({"cli/a.cpp", text + "x\n"}).size(), 1U);
}

TEST(Units, AreMissedInOptions) {
  for (const std::string member :
       {"double radius = 1.0;", "double radius;", "double a_mm = 1.0, b = 2.0;", "float speed{3.0F};",
        "std::optional<double> height;", "std::vector<double> weights;", "std::array<double, 3> corner;",
        "Eigen::Vector3d seen_from;", "double tilt = f(1, 2);", "double length_min;",
        "double gain_mm() const { return 1.0; }\n  double b = 1.0;",
        "int n = 3;  ///< a, b; c\n  double gain = 1.0;"}) {
    EXPECT_EQ(check_units({"cli/a.hpp", "struct FitOptions {\n  " + member + "\n};\n"}).size(), 1U) << member;
    EXPECT_TRUE(check_units({"cli/a.hpp", "struct Fit {\n  " + member + "\n};\n"}).empty()) << member;
  }
}

TEST(Units, OffenceNamesStructMemberAndLine) {
  const auto offences =
      check_units({"cli/a.hpp", "struct FitOptions {\n  int n;\n\n  double gain = 1.0;\n};\n"});
  EXPECT_EQ(to_text(offences), "cli/a.hpp:4: FitOptions::gain does not end in a unit\n");
}

TEST(Units, AreSeenWhereTheyAre) {
  for (const std::string member :
       {"double a_mm = 1.0;", "double a_mm2 = 1.0;", "double a_rad = 0.1;", "double a_deg = 3;",
        "double wait_s = 1;", "double feed_mm_s = 1.0;", "double turn_rad_s = 1.0;", "double rate_hz = 5.0;",
        "double overlap_ratio = 0.3;", "double outlier_sigmas = 4.0;", "double bend_per_mm = 1e-4;",
        "std::optional<double> height_mm;", "Eigen::Vector3d seen_from_mm = {0.0, 0.0, 1.0};",
        "int double_count = 2;", "std::string name = \"double x;\";", "void check(double value) const;",
        "double gain() const { return 1.0; }", "double a_mm = 1.0, b_mm{2.0};",
        "std::function<double(double)> weight;"})
    EXPECT_EQ(to_text(check_units({"cli/a.hpp", "struct FitOptions {\n  " + member + "\n};\n"})), "")
        << member;
}

}  // namespace
}  // namespace arris::arch
