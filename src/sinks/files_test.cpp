#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>

#include "core/file.h"
#include "duoptic/paint.h"
#include "duoptic/sink.h"
#include "paint/turbo.h"
#include "tests/agree.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

/// A folder for one test that is gone afterwards.
class Sinks : public testing::Test {
 protected:
  Sinks() {
    std::string name = (fs::temp_directory_path() / "duoptic_sinks_XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~Sinks() override { fs::remove_all(folder_); }
  int files() const { return static_cast<int>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator())); }
  fs::path folder_;
};

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr std::uint16_t kNone = Disparity::kNone;

TEST_F(Sinks, PfmBytesByHand) {
  const auto d_q4 = test::image<std::uint16_t>({{16, kNone}, {8, 40}});
  ASSERT_TRUE(write_pfm(d_q4, folder_ / "d.pfm"));
  // Rows from bottom to top: 0.5 2.5 / 1 infinity.
  const float rows[] = {0.5f, 2.5f, 1.0f, std::numeric_limits<float>::infinity()};
  EXPECT_EQ(content(folder_ / "d.pfm"), "Pf\n2 2\n-1.0\n" + std::string(reinterpret_cast<const char*>(rows), sizeof rows));
  const auto read = read_pfm(folder_ / "d.pfm");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->at(0, 0), 1.0f);
  EXPECT_TRUE(std::isinf(read->at(0, 1)));
  EXPECT_EQ(read->at(1, 0), 0.5f);
  EXPECT_EQ(read->at(1, 1), 2.5f);
  EXPECT_EQ(files(), 1);
}

TEST_F(Sinks, PfmOfTheOtherByteOrderAndNan) {
  const auto read = parse_pfm(std::string("Pf 2 1 1.0\n\x3F\x80\x00\x00\x7F\xC0\x00\x00", 19), "big");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->at(0, 0), 1.0f);
  EXPECT_TRUE(std::isnan(read->at(0, 1)));
}

TEST_F(Sinks, PfmRefusals) {
  const auto expect_refused = [](std::string_view bytes, const std::string& part) {
    const auto read = parse_pfm(bytes, "my.pfm");
    ASSERT_FALSE(read) << bytes;
    EXPECT_NE(read.error().what.find("my.pfm"), std::string::npos);
    EXPECT_NE(read.error().what.find(part), std::string::npos) << read.error().what;
  };
  expect_refused("", "does not begin with 'Pf'");
  expect_refused("P5\n1 1\n255\nabcd", "does not begin with 'Pf'");
  expect_refused("PF\n1 1\n-1.0\nabcdabcdabcd", "three channels");
  expect_refused("Pf", "no size");
  expect_refused("Pf\n0 1\n-1.0\nabcd", "no size");
  expect_refused("Pf\n-1 1\n-1.0\nabcd", "no size");
  expect_refused("Pf\n16385 1\n-1.0\nabcd", "no size");
  expect_refused("Pf\n99999999999999999999 1\n-1.0\nabcd", "no size");
  expect_refused("Pf\n1x 1\n-1.0\nabcd", "no size");
  expect_refused("Pf\n1 1\n0\nabcd", "no byte order");
  expect_refused("Pf\n1 1\nnan\nabcd", "no byte order");
  expect_refused("Pf\n1 1\n-1.0\nabc", "cut short");
  expect_refused("Pf\n16384 16384\n-1.0\nabcd", "cut short");
  EXPECT_EQ(read_pfm(folder_ / "none.pfm").error().code, ErrorCode::kNotFound);
}

TEST_F(Sinks, PngKeepsEveryPixel) {
  std::mt19937 rng(1);
  Image<std::uint8_t> gray({31, 7});
  Image<std::uint16_t> depth({31, 7});
  Image<Rgb8> color({31, 7});
  test::fill(gray.view(), test::Fill::kRandom, rng);
  test::fill(depth.view(), test::Fill::kRandom, rng);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 31; ++x) color.at(y, x) = {gray.at(y, x), std::uint8_t(x), std::uint8_t(y)};
  ASSERT_TRUE(write_png(gray.view(), folder_ / "gray.png"));
  ASSERT_TRUE(write_png(depth.view(), folder_ / "depth.png"));
  ASSERT_TRUE(write_png(color.view(), folder_ / "color.png"));
  const cv::Mat gray_read = cv::imread(folder_ / "gray.png", cv::IMREAD_UNCHANGED);
  const cv::Mat depth_read = cv::imread(folder_ / "depth.png", cv::IMREAD_UNCHANGED);
  const cv::Mat color_read = cv::imread(folder_ / "color.png", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(gray_read.type(), CV_8UC1);
  ASSERT_EQ(depth_read.type(), CV_16UC1);
  ASSERT_EQ(color_read.type(), CV_8UC3);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 31; ++x) {
      ASSERT_EQ(gray_read.at<std::uint8_t>(y, x), gray.at(y, x));
      ASSERT_EQ(depth_read.at<std::uint16_t>(y, x), depth.at(y, x));
      const auto bgr = color_read.at<cv::Vec3b>(y, x);
      ASSERT_EQ((Rgb8{bgr[2], bgr[1], bgr[0]}), color.at(y, x));
    }
  const auto depth_back = read_png16(folder_ / "depth.png"), gray_back = read_png16(folder_ / "gray.png");
  ASSERT_TRUE(depth_back && gray_back);
  for (int x = 0; x < 31; ++x) {
    EXPECT_EQ(depth_back->at(6, x), depth.at(6, x));
    EXPECT_EQ(gray_back->at(6, x), gray.at(6, x));
  }
  cv::Mat black_and_white(7, 31, CV_8UC1);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 31; ++x) black_and_white.at<std::uint8_t>(y, x) = gray.at(y, x) < 128 ? 0 : 255;
  ASSERT_TRUE(cv::imwrite((folder_ / "one_bit.png").string(), black_and_white, {cv::IMWRITE_PNG_BILEVEL, 1}));
  const auto one_bit = read_png16(folder_ / "one_bit.png");
  ASSERT_TRUE(one_bit) << one_bit.error().what;
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 31; ++x) ASSERT_EQ(one_bit->at(y, x), black_and_white.at<std::uint8_t>(y, x)) << y << " " << x;
  EXPECT_FALSE(read_png16(folder_ / "color.png"));
  EXPECT_FALSE(read_png16(folder_ / "none.png"));
  EXPECT_FALSE(write_png(View<const std::uint8_t>(), folder_ / "empty.png"));
  EXPECT_FALSE(write_png(View<const Rgb8>(), folder_ / "empty.png"));
  EXPECT_EQ(files(), 4);
}

// By hand: f = 100, b = 0.1 m, centre (1, 0); d = 5 px is z = 2 m; the pixel at x = 0 lies 2 / 100 = 0.02 m to the left.
TEST_F(Sinks, PlyByHand) {
  const Rectified rectified{{100, 1, 0, 0.1}, {3, 1}, {}, {}};
  const auto d_q4 = test::image<std::uint16_t>({{80, kNone, 0}});
  Image<Rgb8> color({3, 1});
  color.at(0, 0) = {1, 2, 3};
  ASSERT_TRUE(write_ply(d_q4, color, rectified, folder_ / "c.ply"));
  const std::string bytes = content(folder_ / "c.ply");
  const std::size_t end = bytes.find("end_header\n") + 11;
  EXPECT_NE(bytes.find("element vertex 1\n"), std::string::npos);
  ASSERT_EQ(bytes.size(), end + 15);
  float xyz[3];
  std::memcpy(xyz, bytes.data() + end, 12);
  EXPECT_FLOAT_EQ(xyz[0], -0.02f);
  EXPECT_FLOAT_EQ(xyz[1], 0);
  EXPECT_FLOAT_EQ(xyz[2], 2);
  EXPECT_EQ(bytes.substr(end + 12), "\x01\x02\x03");
}

TEST_F(Sinks, ColorsOfDisparity) {
  // By hand from the published polynomials: at 0 their constants times 255, at 1 the sums of their coefficients times 255.
  EXPECT_EQ(turbo(0), (Rgb8{35, 23, 27}));
  EXPECT_EQ(turbo(1), (Rgb8{144, 13, 0}));
  auto d_q4 = test::constant<std::uint16_t>({320, 100}, 160);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) d_q4.at(y, x) = x < 50 ? 640 : kNone;
  const Image<Rgb8> drawn = draw_disparity(d_q4, nullptr);
  EXPECT_EQ(drawn.width(), 320);
  EXPECT_GT(drawn.height(), 100);
  EXPECT_GT(drawn.at(50, 10).r, drawn.at(50, 10).b);    // near
  EXPECT_EQ(drawn.at(50, 75), Rgb8{});                  // none
  EXPECT_GE(drawn.at(50, 200).b, drawn.at(50, 200).g);  // far
}

TEST_F(Sinks, DrawsWhateverTheSize) {
  const Rectified rectified{{100, 0, 0, 0.1}, {1, 1}, {}, {}};
  for (const Size size : test::awkward_sizes())
    for (const int d : {0, 1, 160, 0xFFFE, 0xFFFF}) {
      const auto d_q4 = test::constant<std::uint16_t>(size, d);
      const Image<Rgb8> color(size);
      EXPECT_EQ(draw_disparity(d_q4, nullptr).width(), size.width);
      EXPECT_EQ(draw_disparity(d_q4, &rectified).width(), size.width);
      EXPECT_EQ(draw_cloud(d_q4, color, rectified, {40, 30}).size(), (Size{40, 30}));
    }
}

TEST_F(Sinks, AFailedWriteLeavesWhatWasThere) {
  const auto d_q4 = test::constant<std::uint16_t>({100, 100}, 16);
  ASSERT_TRUE(write_file(folder_ / "d.pfm", "old"));
  // A limit on file sizes stands for the full disk.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const auto over = write_pfm(d_q4, folder_ / "d.pfm"), fresh = write_pfm(d_q4, folder_ / "e.pfm");
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(over);
  ASSERT_FALSE(fresh);
  EXPECT_EQ(over.error().code, ErrorCode::kWriteFailed);
  EXPECT_NE(over.error().what.find("d.pfm"), std::string::npos);
  EXPECT_EQ(content(folder_ / "d.pfm"), "old");
  EXPECT_EQ(files(), 1);
}

TEST_F(Sinks, NamesWhatCannotBeWritten) {
  const auto d_q4 = test::constant<std::uint16_t>({2, 2}, 16);
  const auto nowhere = write_pfm(d_q4, folder_ / "none" / "d.pfm");
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().what.find("make the folder first"), std::string::npos) << nowhere.error().what;
  const auto folder = write_pfm(d_q4, folder_);
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().what.find("folder or device"), std::string::npos) << folder.error().what;
  EXPECT_FALSE(write_pfm(d_q4, "/dev/full"));
  EXPECT_FALSE(write_pfm(d_q4, folder_ / std::string(250, 'x')));
  EXPECT_EQ(files(), 0);
}

}  // namespace
}  // namespace duo
