// The tree as it is keeps the rules; rules_test.cpp shows that each rule bites.
#include <gtest/gtest.h>

#include "tests/arch/rules.hpp"

namespace arris::arch {
namespace {

const std::vector<SourceFile>& tree() {
  static const std::vector<SourceFile> kTree = read_tree(ARRIS_SOURCE_DIR);
  return kTree;
}

void expect_kept(std::vector<Offence> (*rule)(const SourceFile&)) {
  std::vector<Offence> all;
  for (const SourceFile& file : tree()) {
    const std::vector<Offence> offences = rule(file);
    all.insert(all.end(), offences.begin(), offences.end());
  }
  EXPECT_TRUE(all.empty()) << to_text(all);
}

TEST(Tree, IsRead) {
  EXPECT_GT(tree().size(), 50U);
  for (const std::string room :
       {"types", "geometry", "acquisition", "registration", "toolpath", "report", "cli"})
    EXPECT_TRUE(std::any_of(tree().begin(), tree().end(), [&](const SourceFile& file) {
      return room_of(file.path) == room && is_program_text(file.path);
    })) << room;
}

TEST(Tree, IncludesStayBehindTheDoors) {
  expect_kept(check_doors);
}
TEST(Tree, HeadersShowNoThirdParty) {
  expect_kept(check_quarantine);
}
TEST(Tree, RoomsAreSilent) {
  expect_kept(check_silence);
}
TEST(Tree, FilesAreShort) {
  expect_kept(check_length);
}
TEST(Tree, OptionsNameTheirUnits) {
  expect_kept(check_units);
}

}  // namespace
}  // namespace arris::arch
