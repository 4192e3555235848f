#include "cli/edge_file.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/cli/run_arris.hpp"

namespace arris {
namespace {

EdgeFile sample() {
  EdgeFile file;
  file.scanner = "Hall \"2\" \\ left";
  file.serial = "0042";
  file.edge = {-0.0314, 0.0087};
  file.spacing_mm = 0.5;
  file.date = "2024-02-29";
  file.recipe_sha256 = std::string(64, '0');
  file.cad_sha256 = std::string(64, 'a');
  file.scan_sha256 = {std::string(64, '1'), std::string(64, 'f')};
  return file;
}

/// The first problem of a calibration in which `from` is replaced by `to`.
std::string problem_with(const std::string& from, const std::string& to) {
  std::string text = print_edge_file(sample());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  const EdgeFileRead read = parse_edge_file("edge.toml", text.replace(at, from.size(), to));
  return read.problems.empty() ? std::string() : to_line(read.problems.front());
}

TEST(EdgeFile, ReadsBackAsItWasWritten) {
  const EdgeFile written = sample();
  const EdgeFileRead read = parse_edge_file("edge.toml", print_edge_file(written));
  ASSERT_TRUE(read.problems.empty()) << to_line(read.problems.front());
  EXPECT_EQ(read.file.scanner, written.scanner);
  EXPECT_EQ(read.file.serial, written.serial);
  EXPECT_EQ(read.file.edge.out_mm, written.edge.out_mm);
  EXPECT_EQ(read.file.edge.sd_mm, written.edge.sd_mm);
  EXPECT_EQ(read.file.spacing_mm, written.spacing_mm);
  EXPECT_EQ(read.file.date, written.date);
  EXPECT_EQ(read.file.recipe_sha256, written.recipe_sha256);
  EXPECT_EQ(read.file.cad_sha256, written.cad_sha256);
  EXPECT_EQ(read.file.scan_sha256, written.scan_sha256);
}

TEST(EdgeFile, EveryKeyHasANameOfItsOwnAndAMeaning) {
  EdgeFile file;
  std::set<std::string> names;
  for (const Key& key : edge_keys(file)) {
    EXPECT_TRUE(names.insert(key.name).second) << key.name;
    EXPECT_FALSE(key.about.empty()) << key.name;
  }
}

TEST(EdgeFile, WhatCannotBeTrueIsRefusedInFiveParts) {
  EXPECT_EQ(problem_with("out_mm = -0.0314", "out_mm = -2.1"),
            "edge.out_mm is out of range (edge.toml:14): found -2.1; needed -2 to 2; next: write it again: "
            "arris calibrate edge");
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"sd_mm = 0.0087", "sd_mm = 0.0"},
                                                        {"sd_mm = 0.0087", "sd_mm = 0.2"},
                                                        {"out_mm = -0.0314", "out_mm = nan"},
                                                        {"spacing_mm = 0.5", "spacing_mm = -1.0"},
                                                        {"2024-02-29", "2023-02-29"},
                                                        {"2024-02-29", "29.02.2024"},
                                                        {"2024-02-29", "2024-+2-01"},
                                                        {"\"0042\"", "\"00\\u001b[31m\""},
                                                        {"\"0042\"", "\"" + std::string(101, 'x') + "\""},
                                                        {std::string(64, 'a'), std::string(64, 'A')},
                                                        {std::string(64, '1'), std::string(63, '1')},
                                                        {"schema = 1", "schema = 2"},
                                                        {"[edge]", "[edges]"}}) {
    const std::string problem = problem_with(from, to);
    EXPECT_NE(problem.find("edge.toml"), std::string::npos) << from << " -> " << to << ": " << problem;
    EXPECT_NE(problem.find("found "), std::string::npos) << problem;
    EXPECT_NE(problem.find("needed "), std::string::npos) << problem;
    EXPECT_NE(problem.find("next: write it again"), std::string::npos) << problem;
  }
}

TEST(EdgeFile, ListsAreBounded) {
  EdgeFile file = sample();
  file.scan_sha256.assign(1001, std::string(64, '1'));
  EXPECT_FALSE(parse_edge_file("edge.toml", print_edge_file(file)).problems.empty());
  file.scan_sha256.clear();
  EXPECT_FALSE(parse_edge_file("edge.toml", print_edge_file(file)).problems.empty());
}

TEST(EdgeFile, LargerThanAnyIsNotRead) {
  const testing::TestFolder folder;
  const auto file = folder.write("edge.toml", std::string(200000, '#'));
  EXPECT_THROW((void)read_edge_file(file), Error);
  EXPECT_THROW((void)read_edge_file(folder.path() / "missing.toml"), Error);
}

}  // namespace
}  // namespace arris
