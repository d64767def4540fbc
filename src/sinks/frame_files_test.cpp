// The files of a frame fit each other: depth with its camera gives the points, and the surface where it is.
#include "duoptic/frame_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "core/libav.h"
#include "duoptic/source.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

/// A slanted wall, z = 1.2 m + x / 4, before a canvas whose axis is far from its middle. Depth is what the disparity says.
struct Wall {
  static constexpr Size kSize = {96, 72};
  static constexpr double kNear_m = 1.2, kSlant = 0.25;
  Wall() {
    rectified.focal_px = 80.25;
    rectified.cx_px = 31.5;
    rectified.cy_px = 44.75;
    rectified.baseline_m = 0.6;
    rectified.size = kSize;
    frame.color = Image<Rgb8>(kSize);
    frame.depth_mm = Image<std::uint16_t>(kSize);
    frame.disparity.d_q4 = Image<std::uint16_t>(kSize);
    frame.disparity.origin = Image<std::uint8_t>(kSize);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const double slope = (x - rectified.cx_px) / rectified.focal_px, z_m = kNear_m / (1 - kSlant * slope);
        const bool hole = x < 3 && y < 3;
        const auto d_q4 = static_cast<std::uint16_t>(std::lround(16 * rectified.disparity_px(z_m)));
        frame.color.at(y, x) = {static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(3 * y), 7};
        frame.disparity.d_q4.at(y, x) = hole ? Disparity::kNone : d_q4;
        frame.depth_mm.at(y, x) =
            hole ? std::uint16_t{0} : static_cast<std::uint16_t>(std::lround(1000 * rectified.depth_m(d_q4 / 16.0)));
      }
  }
  Rectified rectified;
  Frame frame;
};

struct Point {
  std::array<float, 3> p_m;
  std::array<std::uint8_t, 3> color;
};

class FrameFilesTest : public testing::Test {
 protected:
  FrameFilesTest() {
    std::string name = (fs::temp_directory_path() / "duoptic_frame_XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~FrameFilesTest() override { fs::remove_all(folder_); }

  void write(const FrameFiles& files, bool rig = true) {
    const auto written = write_frame(wall_.frame, rig ? std::optional(wall_.rectified) : std::nullopt, files,
                                     [&](const std::string& name) { return folder_ / name; });
    ASSERT_TRUE(written) << written.error().what;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_)) out.push_back(entry.path().filename());
    std::sort(out.begin(), out.end());
    return out;
  }
  std::string bytes(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  nlohmann::json camera() const { return nlohmann::json::parse(bytes("camera.json")); }
  std::vector<Point> cloud() const {
    const std::string text = bytes("cloud.ply");
    const std::size_t data = text.find("end_header\n") + 11;
    std::vector<Point> out;
    for (std::size_t at = data; at + 15 <= text.size(); at += 15) {
      Point& p = out.emplace_back();
      std::memcpy(p.p_m.data(), text.data() + at, 12);
      std::memcpy(p.color.data(), text.data() + at + 12, 3);
    }
    return out;
  }

  Wall wall_;
  fs::path folder_;
};

TEST_F(FrameFilesTest, DepthAndCameraGiveThePoints) {
  write({});
  EXPECT_EQ(names(), (std::vector<std::string>{"camera.json", "cloud.ply", "depth.png", "disparity.pfm", "disparity.png",
                                               "left_rectified.png"}));
  const nlohmann::json of = camera();
  EXPECT_EQ(of["width"], Wall::kSize.width);
  EXPECT_EQ(of["height"], Wall::kSize.height);
  const std::vector<double> k = of["K"], q = of["Q"];
  const double unit_m = of["depth_unit_m"];
  const auto depth = read_png16(folder_ / of["depth"].get<std::string>());
  ASSERT_TRUE(depth);
  ASSERT_EQ(depth->size(), Wall::kSize);
  const auto picture = open_source(folder_ / of["picture"].get<std::string>());
  ASSERT_TRUE(picture);
  EXPECT_EQ((*picture)->size(), Wall::kSize);
  const std::vector<Point> points = cloud();
  std::size_t n = 0;
  for (int y = 0; y < depth->height(); ++y)
    for (int x = 0; x < depth->width(); ++x) {
      if (depth->at(y, x) == 0) continue;
      ASSERT_LT(n, points.size());
      const Point& point = points[n++];
      const double z_m = unit_m * depth->at(y, x);
      EXPECT_NEAR((x - k[2]) / k[0] * z_m, point.p_m[0], 0.001);
      EXPECT_NEAR((y - k[5]) / k[4] * z_m, point.p_m[1], 0.001);
      EXPECT_NEAR(z_m, point.p_m[2], 0.001);
      EXPECT_EQ(point.color[0], 2 * x);  // of the same pixel of the picture
      // OpenCV: (X Y Z W) = Q (x y d 1).
      const double d_px = wall_.frame.disparity.d_q4.at(y, x) / 16.0, w = q[14] * d_px + q[15];
      EXPECT_NEAR((x + q[3]) / w, point.p_m[0], 1e-5);
      EXPECT_NEAR((y + q[7]) / w, point.p_m[1], 1e-5);
      EXPECT_NEAR(q[11] / w, point.p_m[2], 1e-5);
    }
  EXPECT_EQ(n, points.size());
  EXPECT_EQ(n, static_cast<std::size_t>(Wall::kSize.width * Wall::kSize.height - 9));
}

/// What other programs do with depth and camera: a truncated signed distance in each voxel, and the surface where it is zero.
///
/// Source  Curless, Levoy, "A volumetric method for building complex models from range images", 1996
TEST_F(FrameFilesTest, AVolumeBuiltFromThemIsNotShifted) {
  write({});
  const std::vector<double> k = camera()["K"];
  const auto depth = read_png16(folder_ / "depth.png");
  ASSERT_TRUE(depth);
  constexpr double kVoxel_m = 0.01, kReach_m = 0.04;
  const auto distance_m = [&](double x, double y, double z) -> std::optional<double> {
    const int column = static_cast<int>(std::lround(k[0] * x / z + k[2])),
              row = static_cast<int>(std::lround(k[4] * y / z + k[5]));
    if (column < 0 || row < 0 || column >= depth->width() || row >= depth->height() || depth->at(row, column) == 0) return {};
    return std::clamp(0.001 * depth->at(row, column) - z, -kReach_m, kReach_m);
  };
  double sum_m = 0, worst_m = 0;
  int columns = 0;
  for (double y = -0.5; y < 0.3; y += 0.05)
    for (double x = -0.35; x < 0.8; x += 0.05) {
      std::optional<double> before;
      for (double z = 1; z < 1.8; z += kVoxel_m) {
        const auto here = distance_m(x, y, z);
        if (before && here && *before > 0 && *here <= 0 && *before < kReach_m) {
          const double surface_m = z - kVoxel_m * (-*here) / (*before - *here),
                       off_m = surface_m - (Wall::kNear_m + Wall::kSlant * x);
          sum_m += off_m;
          worst_m = std::max(worst_m, std::abs(off_m));
          ++columns;
        }
        before = here;
      }
    }
  EXPECT_GT(columns, 150);
  EXPECT_LT(std::abs(sum_m / columns), 0.001);
  EXPECT_LT(worst_m, 0.006);  // half a pixel of the slant, and a sixteenth of disparity
}

TEST_F(FrameFilesTest, OnlyWhatIsAskedForAndNothingFar) {
  FrameFiles files;
  files.outputs = {FrameOutput::kCloud, FrameOutput::kDepth};
  files.cloud.far_m = 1.2;
  files.cloud.axes = Axes::kBlender;
  write(files);
  EXPECT_EQ(names(), (std::vector<std::string>{"cloud.ply", "depth.png"}));
  const std::vector<Point> points = cloud();
  ASSERT_FALSE(points.empty());
  for (const Point& p : points) EXPECT_LE(p.p_m[1], 1.2f);  // y is forward
  EXPECT_NE(bytes("cloud.ply").find("x right, y forward, z up"), std::string::npos);
  const auto depth = read_png16(folder_ / "depth.png");
  ASSERT_TRUE(depth);
  std::size_t known = 0;
  for (int y = 0; y < depth->height(); ++y)
    for (int x = 0; x < depth->width(); ++x) known += depth->at(y, x) != 0;
  EXPECT_NEAR(static_cast<double>(known), static_cast<double>(points.size()), 1 * Wall::kSize.height);
  EXPECT_LT(known, static_cast<std::size_t>(Wall::kSize.width * Wall::kSize.height) / 2);
}

TEST_F(FrameFilesTest, WithoutARigThereAreDisparitiesAlone) {
  write({}, false);
  EXPECT_EQ(names(), (std::vector<std::string>{"disparity.pfm", "disparity.png"}));
}

TEST_F(FrameFilesTest, NothingIsCalledMetresWhereNothingIsMetric) {
  FrameFiles files;
  files.cloud.metric = false;
  write(files);
  EXPECT_TRUE(camera()["depth_unit_m"].is_null());
  EXPECT_EQ(camera()["metric"], false);
  EXPECT_EQ(bytes("cloud.ply").find("metres"), std::string::npos);
}

/// All values of the pictures of a video of 16 bits gray, with the time of each.
std::map<std::int64_t, std::vector<std::uint16_t>> decoded(const fs::path& path) {
  AVFormatContext* opened = nullptr;
  EXPECT_GE(avformat_open_input(&opened, path.c_str(), nullptr, nullptr), 0);
  EXPECT_GE(avformat_find_stream_info(opened, nullptr), 0);
  const AVStream& stream = *opened->streams[0];
  EXPECT_EQ(stream.codecpar->codec_id, AV_CODEC_ID_FFV1);
  const av::Coder decoder(avcodec_alloc_context3(avcodec_find_decoder(AV_CODEC_ID_FFV1)));
  avcodec_parameters_to_context(decoder.get(), stream.codecpar);
  EXPECT_GE(avcodec_open2(decoder.get(), nullptr, nullptr), 0);
  const av::Packet packet(av_packet_alloc());
  const av::CodedFrame frame(av_frame_alloc());
  std::map<std::int64_t, std::vector<std::uint16_t>> out;
  while (av_read_frame(opened, packet.get()) >= 0) {
    EXPECT_GE(avcodec_send_packet(decoder.get(), packet.get()), 0);
    EXPECT_GE(avcodec_receive_frame(decoder.get(), frame.get()), 0);
    EXPECT_EQ(frame->format, AV_PIX_FMT_GRAY16LE);
    auto& values = out[av_rescale_q(packet->pts, stream.time_base, {1, 1000})];
    for (int y = 0; y < frame->height; ++y) {
      const auto* row = reinterpret_cast<const std::uint16_t*>(frame->data[0] + y * frame->linesize[0]);
      values.insert(values.end(), row, row + frame->width);
    }
    av_packet_unref(packet.get());
  }
  avformat_close_input(&opened);
  return out;
}

TEST_F(FrameFilesTest, DepthOfAVideoComesBackToTheMillimetre) {
  auto video = DepthVideo::open(folder_ / "depth.mkv", Wall::kSize, 1.0 / 30);
  ASSERT_TRUE(video) << video.error().what;
  ASSERT_TRUE(video->write(wall_.frame.depth_mm, 0));
  EXPECT_TRUE(names().size() == 1 && names()[0] != "depth.mkv");  // not before it is whole
  const Image<std::uint16_t> near = near_depth(wall_.frame.depth_mm, 1.2);
  ASSERT_TRUE(video->write(near, 0.1));
  ASSERT_TRUE(video->finish());
  EXPECT_EQ(names(), std::vector<std::string>{"depth.mkv"});
  const auto read = decoded(folder_ / "depth.mkv");
  ASSERT_EQ(read.size(), 2U);
  const std::pair<int, const Image<std::uint16_t>*> expected[] = {{0, &wall_.frame.depth_mm}, {100, &near}};
  for (const auto& [ms, depth] : expected) {
    ASSERT_EQ(read.count(ms), 1U);
    std::size_t at = 0;
    for (int y = 0; y < depth->height(); ++y)
      for (int x = 0; x < depth->width(); ++x) ASSERT_EQ(read.at(ms)[at++], depth->at(y, x));
  }
}

TEST_F(FrameFilesTest, AFolderOfFramesHasThemBelowIt) {
  const auto frame = std::make_shared<const Frame>(std::move(wall_.frame));
  const FrameFiles both{.outputs = {FrameOutput::kDepth, FrameOutput::kDepthVideo}};
  {
    auto out = FrameFolder::open(folder_, both, true, wall_.rectified, false, 1.0 / 30);
    ASSERT_TRUE(out) << out.error().what;
    for (const std::uint64_t number : {3, 5}) ASSERT_TRUE(out->write(frame, number, static_cast<double>(number) / 30));
    EXPECT_FALSE(fs::exists(folder_ / "depth.mkv")) << "before it is whole";
    ASSERT_TRUE(out->finish());
    EXPECT_EQ(out->paths().size(), 4U);
    EXPECT_EQ(out->paths()[0], (folder_ / "frame_000003/depth.png").string());
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"camera.json", "depth.mkv", "frame_000003", "frame_000005"}));
  const auto refused = [&](bool asked, const std::optional<Rectified>& rectified, bool still) {
    const auto out = FrameFolder::open(folder_, both, asked, rectified, still, 1.0 / 30);
    return out ? std::string() : out.error().what;
  };
  EXPECT_EQ(refused(true, {}, false), "cannot write depth: it needs a rig; give one with --rig");
  EXPECT_EQ(refused(false, {}, false), "");
  EXPECT_EQ(refused(true, wall_.rectified, true), "cannot write depth-video of one picture; take --outputs depth");
}

TEST(FarWatch, WarnsWhereALimitLeavesAlmostNothing) {
  Image<std::uint16_t> depth_mm({100, 10});
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 100; ++x) depth_mm.at(y, x) = static_cast<std::uint16_t>(x < 50 ? 0 : 2000 + x);  // half unknown
  FarWatch none(1.5), all(3), without(kNoFarLimit_m);
  for (FarWatch* watch : {&none, &all, &without}) watch->see(depth_mm);
  EXPECT_EQ(none.warning(), "almost all that was found lies farther than --far 1.5 and is left out: the nearest is at 2.05");
  EXPECT_EQ(all.warning(), "");
  EXPECT_EQ(without.warning(), "");
  EXPECT_EQ(FarWatch(1).warning(), "") << "nothing was seen";
}

}  // namespace
}  // namespace duo
