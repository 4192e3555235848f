#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

TEST(ReadOff, CountsOnTheirOwnLineOrBesideTheKeyword) {
  for (const char* front :
       {"OFF\n4 1 0\n", "OFF 4 1 0\n", "# made by hand\nOFF # keyword\n\n4 1 0 # counts\n",
        "OFF\r\n4 1 0\r\n", "COFF\n4 1\n"}) {
    const auto loaded =
        load(std::string(front) + "0 0 0\n1 0 0\n\n1 1 0 # corner\n0 1 0\n4 0 1 2 3 255 0 0\n", "part.off");
    EXPECT_EQ(loaded.format, "off ascii");
    EXPECT_EQ(loaded.points(), 4U);
    const std::vector<std::array<std::int32_t, 3>> truth = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(loaded.triangles, truth) << front;
  }
}

TEST(ReadOff, NormalsOfNoff) {
  const auto loaded = load("NOFF\n1 0 0\n1 2 3 0 0 4\n");
  ASSERT_EQ(loaded.normals.size(), 1U);
  EXPECT_EQ(loaded.normals[0], Eigen::Vector3f(0, 0, 1));
}

TEST(ReadOff, LineEndsOfCrAlone) {
  EXPECT_EQ(load("OFF\r1 0 0\r1 2 3\r").points(), 1U);
}

TEST(ReadOff, SaysWhatIsWrong) {
  const std::pair<const char*, const char*> table[] = {
      {"STOFF\n1 0 0\n", "this kind of OFF file is not read"},
      {"OFF BINARY\n", "binary OFF files are not read"},
      {"OFF\n", "the OFF file ends early"},
      {"#\1", "the OFF file ends early (part.off): found 0 lines that are no comments"},
      {"OFF\nfour 1 0\n", "the OFF counts cannot be read"},
      {"OFF\n4\n", "the OFF counts cannot be read"},
      {"OFF\n4 1 0\n0 0 0\n", "the OFF file ends early"},
      {"OFF\n18446744073709551615 1 0\n0 0 0\n", "the OFF file ends early"},
      {"OFF\n1 18446744073709551615 0\n0 0 0\n", "the OFF file ends early"},
      {"OFF\n2 0 0\n0 0 0 0 0 0\n", "the OFF file ends early"},
      {"OFF\n1 1 0\n0 0 0        \n", "the OFF file ends early (part.off): found 0 faces; needed 1"},
      {"OFF\n1 0 0\n0 zero 0\n", "an OFF row is not a row of numbers (part.off, line 3)"},
      {"OFF\n1 1 0\n0 0 0\n3 0 0\n", "an OFF row is not a row of numbers (part.off, line 4)"},
      {"OFF\n1 1 0\n0 0 0\n3 0 0 1\n",
       "a face uses a point that does not exist (part.off, face 1): found index 1; needed 0 to 0"},
      {"OFF\n0 0 0\n", "the file holds no points"},
  };
  for (const auto& [bytes, message] : table)
    EXPECT_TRUE(says(error_of_bytes(bytes, "part.off"), message)) << bytes;
}

}  // namespace
}  // namespace arris::testing
