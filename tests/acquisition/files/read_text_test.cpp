#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

/// All must be read as (1.5, -2, 300) and (4, 5.25, 6).
TEST(ReadText, SeparatorsDecimalMarksAndLineEnds) {
  for (const char* bytes : {
           "1.5 -2 300\n4 5.25 6\n",
           "1.5 -2 300\r\n4 5.25 6\r\n",
           "1.5 -2 300\r4 5.25 6\r",
           "  1.5   -2\t 300  \n\n4 5.25 6",
           "1.5\t-2\t300\n4\t5.25\t6\n",
           "1,5\t-2\t300\n4\t5,25\t6\n",
           "1.5,-2,300\n4,5.25,6\n",
           "1.5 , -2 , 300\n4 , 5.25 , 6\n",
           "1.5, -2, 3e2\n4, 5.25, 6\n",
           "1.5;-2;300\n4;5.25;6\n",
           "1,5;-2;3,0E+2\n4;5,25;6\n",
           "1,5 ; -2 ; 300\n4 ; 5,25 ; 6\n",
           "1,5 -2 300\n4 5,25 6\n",
           "1.5,-2,300,\n4,5.25,6,\n",
           "+1.5 -2. 300\n4 5.25 6\n",
           "# a comment\n1.5 -2 300\n# another\n  // and this\n4 5.25 6\n",
           "\xEF\xBB\xBFx,y,z\n1.5,-2,300\n4,5.25,6\n",
           "x y z\n1.5 -2 300\n4 5.25 6\n",
           "X;Y;Z\n1,5;-2;300\n4;5,25;6\n",
           "\"x\",\"y\",\"z\"\n1.5,-2,300\n4,5.25,6\n",
           "//X Y Z\n1.5 -2 300\n4 5.25 6\n",
           "x, y, z\n1.5 -2 300\n4 5.25 6\n",
           "index,z,name,y,x\n0,300,a b,-2,1.5\n1,6,,5.25,4\n",
           "Points:0,Points:1,Points:2\n1.5,-2,300\n4,5.25,6\n",
           "2\n1.5 -2 300 77\n4 5.25 6 78\n",
           "1.5 -2 300 255 255 255 0.5\n4 5.25 6 1 2 3 0.25\n",
       }) {
    const auto loaded = load(bytes, "scan.txt", true);
    ASSERT_EQ(loaded.points(), 2U) << bytes;
    EXPECT_EQ(point_of(loaded, 0), Eigen::Vector3d(1.5, -2, 300)) << bytes;
    EXPECT_EQ(point_of(loaded, 1), Eigen::Vector3d(4, 5.25, 6)) << bytes;
    EXPECT_TRUE(loaded.normals.empty()) << bytes;
  }
}

TEST(ReadText, NormalsByHeader) {
  for (const char* header : {"x y z nx ny nz", "# x y z Nx Ny Nz", "X [mm] Y [mm] Z [mm] I J K"}) {
    const auto loaded = load(std::string(header) + "\n1 2 3 0 0 2\n4 5 6 1 0 0\n");
    ASSERT_EQ(loaded.normals.size(), 2U) << header;
    EXPECT_EQ(loaded.normals[0], Eigen::Vector3f(0, 0, 1));
  }
}

TEST(ReadText, NormalsWithoutHeaderOnlyWhenAllAreUnitVectors) {
  const auto unit = load("1 2 3 0 0 1\n4 5 6 0.6 0.8 0\n7 8 9 -1 0 0\n");
  EXPECT_EQ(unit.normals.size(), 3U);
  EXPECT_TRUE(says(unit.notes.at(0), "read as normals"));
  const auto colours = load("1 2 3 0 0 1\n4 5 6 0.6 0.8 0\n7 8 9 0.5 0.5 0.5\n");
  EXPECT_TRUE(colours.normals.empty());
  EXPECT_EQ(colours.extra_names.size(), 3U);
}

TEST(ReadText, UnitFromCommentOrColumnName) {
  EXPECT_EQ(load("# units: inches\n1 2 3\n").unit_hint, "inch");
  EXPECT_EQ(load("x [m],y [m],z [m]\n1,2,3\n").unit_hint, "m");
  EXPECT_EQ(load("x_mm,y_mm,z_mm\n1,2,3\n").unit_hint, "mm");
  EXPECT_EQ(load("# a unit test\n1 2 3\n").unit_hint, "");
}

TEST(ReadText, NonFiniteRowsAreDroppedAndCounted) {
  const auto loaded =
      load("1 2 3\nnan nan nan\ninf 0 0\n-1.#IND 0 0\n1e400 0 0\n4 5 6\n1.#QNAN 1 1\nNaN 1 1\n");
  EXPECT_EQ(loaded.nonfinite, 6U);
  EXPECT_EQ(loaded.points(), 2U);
  EXPECT_EQ(point_of(loaded, 1), Eigen::Vector3d(4, 5, 6));
}

TEST(ReadText, MapCoordinatesKeepTheirDigits) {
  const auto loaded =
      load("665187.522077 5648349.895035 241.767693\n665180.366089 5648347.104624 241.992427\n0 0 0\n");
  EXPECT_NEAR(point_of(loaded, 0).y(), 5648349.895035, 1e-6);
  EXPECT_NEAR(point_of(loaded, 1).x(), 665180.366089, 1e-6);
}

TEST(ReadText, ManyRowsOverChunkBordersComeInOrder) {
  std::string bytes;
  const int count = 200000;  // several chunks
  for (int i = 0; i < count; ++i) {
    if (i % 1000 == 7) bytes += "# comment\n\n";
    bytes += std::to_string(i % 977) + ".25 " + std::to_string(i / 977) + " 1\n";
  }
  const auto loaded = load(bytes);
  ASSERT_EQ(loaded.points(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    ASSERT_EQ(point_of(loaded, static_cast<std::size_t>(i)), Eigen::Vector3d(i % 977 + 0.25, i / 977, 1))
        << i;
}

TEST(ReadText, SaysWhatIsWrong) {
  const std::pair<const char*, const char*> table[] = {
      {"# nothing\n\n", "the file holds no points"},
      {"1 2\n3 4\n", "the rows have too few columns (scan.txt, line 1): found 2 in '1 2'"},
      {"a,b,c\n1,2,3\n", "the header does not name the coordinates (scan.txt, line 1): found 'a,b,c'"},
      {"x y\n1 2\n", "the header does not name the coordinates"},
      {"0,1.5,2,3\n1,1.5,2,4\n2,1.5,2,5\n", "the first column counts the rows"},
      {"1 2 3\n4 5\n6 7 8\n",
       "a row is not a row of numbers (scan.txt, line 2): found '4 5'; needed 3 columns"},
      {"1 2 3\n4 5 six\n6 7 8\n", "a row is not a row of numbers (scan.txt, line 2)"},
      {"1 2 3\n4 5 6x\n6 7 8\n", "a row is not a row of numbers (scan.txt, line 2)"},
      {"1\t2\t3\t4\n1\t\t2\t3\n6\t7\t8\t9\n", "a row is not a row of numbers (scan.txt, line 2)"},
      {"1 2 3\n4 5 6\n7 8",
       "the last row is not a row of numbers: was the file cut short? (scan.txt, line 3)"},
      {"3\n1 2 3\n4 5 6\n",
       "the file ends early (scan.txt): found 2 points; needed 3, as its first line says"},
      {"nan nan nan\n", "no point of the file is finite (scan.txt): found 1 points"},
  };
  for (const auto& [bytes, message] : table)
    EXPECT_TRUE(says(error_of_bytes(bytes, "scan.txt"), message)) << bytes;
}

TEST(ReadText, NotesWhatIsOdd) {
  EXPECT_TRUE(says(load("1 2 3\n4 5 6").notes.at(0), "no line end"));
  EXPECT_TRUE(says(load("1\n1 2 3\n4 5 6\n").notes.at(0), "the first line says 1 points, the file has 2"));
}

}  // namespace
}  // namespace arris::testing
