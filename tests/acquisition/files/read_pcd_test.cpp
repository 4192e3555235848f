#include "acquisition/files/lzf.hpp"
#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

struct Layout {
  std::string fields = "x y z";
  std::string size = "4 4 4";
  std::string type = "F F F";
  std::string count = "1 1 1";
  std::string width = "2";
  std::string height = "1";
  std::string points = "2";
};

std::string header(const std::string& data, const Layout& h = {}) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + h.fields + "\nSIZE " + h.size +
         "\nTYPE " + h.type + "\nCOUNT " + h.count + "\nWIDTH " + h.width + "\nHEIGHT " + h.height +
         "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + h.points + "\nDATA " + data + "\n";
}

/// LZF that packs nothing: runs of up to 32 bytes as they are.
std::string packed_plainly(const std::string& bytes) {
  std::string packed;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    const std::string run = bytes.substr(at, 32);
    packed += static_cast<char>(run.size() - 1);
    packed += run;
  }
  return packed;
}

std::string compressed(const std::string& packed, std::size_t size) {
  Bytes bytes;
  bytes.little(static_cast<std::uint32_t>(packed.size()))
      .little(static_cast<std::uint32_t>(size))
      .text(packed);
  return bytes.str();
}

TEST(ReadPcd, AsciiWithFieldsOfSeveralValuesAndNan) {
  Layout h;
  h.fields = "histogram x rgb y z";
  h.size = "4 4 4 4 8";
  h.type = "F F U F F";
  h.count = "3 1 1 1 1";
  h.width = "3";
  h.points = "3";
  const auto loaded =
      load(header("ascii", h) + "9 9 9 1 255 2 3\n9 9 9 nan 255 nan nan\n9 9 9 4 255 5 6\n", "scan.pcd");
  EXPECT_EQ(loaded.format, "pcd ascii");
  EXPECT_EQ(loaded.nonfinite, 1U);
  ASSERT_EQ(loaded.points(), 2U);
  EXPECT_EQ(point_of(loaded, 1), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(loaded.extra_names, (std::vector<std::string>{"histogram", "rgb"}));
}

TEST(ReadPcd, VersionFiveHasColumnsAndNoCounts) {
  const auto loaded = load(
      "VERSION .5\r\nCOLUMNS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nWIDTH 1\r\nHEIGHT 2\r\nDATA ascii\r\n1 2 "
      "3\r\n4 5 6\r\n");
  EXPECT_EQ(loaded.points(), 2U);
}

TEST(ReadPcd, BinaryAndCompressedGiveTheSame) {
  Layout h;
  h.fields = "x intensity y z normal_x normal_y normal_z";
  h.size = "4 2 8 4 4 4 4";
  h.type = "F U F I F F F";
  h.count = "1 3 1 1 1 1 1";
  Bytes rows;
  Bytes columns;
  for (int i = 0; i < 2; ++i) {
    rows.little(1.5F + static_cast<float>(i));
    for (int k = 0; k < 3; ++k) rows.little<std::uint16_t>(7);
    rows.little(0.1 + i).little(-3 - i).little(0.0F).little(0.0F).little(1.0F);
  }
  for (int i = 0; i < 2; ++i) columns.little(1.5F + static_cast<float>(i));
  for (int i = 0; i < 6; ++i) columns.little<std::uint16_t>(7);
  for (int i = 0; i < 2; ++i) columns.little(0.1 + i);
  for (int i = 0; i < 2; ++i) columns.little(-3 - i);
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 2; ++i) columns.little(axis == 2 ? 1.0F : 0.0F);
  const auto plain = load(header("binary", h) + rows.str(), "scan.pcd", true);
  const auto packed =
      load(header("binary_compressed", h) + compressed(packed_plainly(columns.str()), columns.str().size()),
           "scan.pcd", true);
  EXPECT_EQ(plain.format, "pcd binary");
  EXPECT_EQ(packed.format, "pcd binary compressed");
  for (const auto* loaded : {&plain, &packed}) {
    ASSERT_EQ(loaded->points(), 2U);
    EXPECT_EQ(point_of(*loaded, 1), Eigen::Vector3d(2.5, 1.1, -4));
    ASSERT_EQ(loaded->normals.size(), 2U);
    EXPECT_EQ(loaded->normals[1], Eigen::Vector3f(0, 0, 1));
  }
}

TEST(ReadPcd, OrganisedCloudKeepsItsFinitePoints) {
  Layout h;
  h.width = "2";
  h.height = "2";
  h.points = "4";
  Bytes rows;
  for (const float v : {1.F, 2.F, 3.F, NAN, NAN, NAN, 4.F, 5.F, 6.F, NAN, 0.F, 0.F}) rows.little(v);
  const auto loaded = load(header("binary", h) + rows.str());
  EXPECT_EQ(loaded.points(), 2U);
  EXPECT_EQ(loaded.nonfinite, 2U);
  EXPECT_TRUE(says(loaded.notes.at(0), "organised: 2 x 2"));
}

TEST(ReadPcd, LzfMatchesMayOverlapThemselves) {
  // 'a', then 8 bytes from 1 back; then 'bc', then 9 + 2 bytes from 2 back (a long match).
  const std::string packed = std::string("\x00", 1) + "a" + std::string("\xC0\x00", 2) + "\x01" + "bc" +
                             std::string("\xE0\x02\x01", 3);
  std::string out(9 + 2 + 11, '?');
  EXPECT_TRUE(files::unpack_lzf(packed, out));
  EXPECT_EQ(out, "aaaaaaaaabcbcbcbcbcbcb");
  EXPECT_FALSE(files::unpack_lzf(packed, std::span(out).subspan(1))) << "more comes out than was announced";
  for (std::size_t cut = 1; cut < packed.size(); ++cut)
    EXPECT_FALSE(files::unpack_lzf(packed.substr(0, cut), out)) << cut;
  EXPECT_FALSE(files::unpack_lzf(std::string("\x20\x00", 2), out)) << "a match before the first byte";
}

TEST(ReadPcd, SaysWhatIsWrong) {
  const auto with = [](auto change) {
    Layout h;
    change(h);
    return h;
  };
  const std::string rows = "1 2 3\n4 5 6\n";
  const std::string body(24, '\0');
  const std::pair<std::string, const char*> table[] = {
      {"VERSION 0.7\nFIELDS x y z\n", "the PCD header ends early"},
      {header("ascii", with([](Layout& h) { h.size = "4 4"; })) + rows,
       "the PCD header disagrees with itself"},
      {header("ascii", with([](Layout& h) { h.points = "3"; })) + rows,
       "the PCD header disagrees with itself"},
      {header("ascii", with([](Layout& h) { h.width = "two"; })) + rows,
       "a PCD header number cannot be read"},
      {header("ascii", with([](Layout& h) { h.width = "-2"; })) + rows, "a PCD header number cannot be read"},
      {header("ascii", with([](Layout& h) { h.width = ""; })) + rows, "a PCD header number cannot be read"},
      {header("hex") + rows, "the PCD data kind is not known"},
      {"VERSION 0.7\nFIELD x y z\nDATA ascii\n", "a PCD header line is not known"},
      {"VERSION 0.7\nFIELDS x y z\nDATA ascii\n", "the PCD header gives no number of points"},
      {header("ascii", with([](Layout& h) { h.fields = "a b c"; })) + rows,
       "the PCD file has no coordinates"},
      {header("ascii", with([](Layout& h) { h.count = "1 1 512"; })) + rows,
       "the PCD file has no coordinates"},
      {header("binary", with([](Layout& h) { h.count = "1 1 99999999999"; })) + body,
       "a PCD field is larger than the file"},
      {header("binary", with([](Layout& h) { h.size = "4 4 3"; })) + body, "a PCD field has an unknown type"},
      {header("binary", with([](Layout& h) { h.type = "F F Q"; })) + body, "a PCD field has an unknown type"},
      {header("ascii") + "1 2 3\n", "the PCD file ends early"},
      {header("ascii") + rows + "7 8 9\n", "the PCD file has more points than it says"},
      {header("binary") + body.substr(1), "the PCD file ends early"},
      {header("binary", with([](Layout& h) { h.width = h.points = "4294967296"; })) + body,
       "the PCD file ends early"},
      {header("binary", with([](Layout& h) {
                h.width = "4294967296";
                h.height = "4294967296";
                h.points = "18446744073709551615";
              })) +
           body,
       "the PCD file ends early"},
      {header("binary_compressed") + "1234", "the PCD file ends early"},
      {header("binary_compressed") + compressed(packed_plainly(body), 24).substr(0, 20),
       "the PCD file ends early"},
      {header("binary_compressed") + compressed(packed_plainly(body), 25),
       "another size than the header says"},
      {header("binary_compressed") + compressed("\x20", 24), "the compressed PCD data are damaged"},
  };
  for (const auto& [bytes, message] : table) EXPECT_TRUE(says(error_of_bytes(bytes, "scan.pcd"), message));
}

TEST(ReadPcd, PackedDataCannotAskForMoreThanTheyCanHold) {
  Layout h;
  h.width = h.points = "300000000";
  EXPECT_TRUE(
      says(error_of_bytes(header("binary_compressed", h) + compressed("12345678", 3600000000U), "scan.pcd"),
           "another size than the header says"));
}

}  // namespace
}  // namespace arris::testing
