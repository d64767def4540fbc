// One live camera: what it gives, and what it says when it does not; two of them opened together.
#include "sources/camera/camera.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <random>
#include <vector>

#include "sources/camera/decode.h"
#include "sources/camera/modes.h"
#include "tests/camera_desk.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the desk and its cameras

std::string jpeg() {
  std::string bytes;
  auto encoder = test::make_encoder(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P);
  encoder.encode(test::pattern(AV_PIX_FMT_YUVJ420P, 0).get(),
                 [&](AVPacket& p) { bytes.assign(reinterpret_cast<char*>(p.data), static_cast<std::size_t>(p.size)); });
  return bytes;
}

std::unique_ptr<Source> opened(Desk& desk, const std::string& name = "camera:0", const CameraWish& wish = kWish) {
  auto camera = open_camera(desk.calls, name, wish);
  EXPECT_TRUE(camera) << camera.error().what;
  return camera ? std::move(*camera) : nullptr;
}

/// The next picture; false when none comes in three seconds of the desk's clock.
bool picture_of(Source& camera, const Desk& desk, Picture& into) {
  for (const TimeNs start = desk.now(); desk.now() - start < 3000 * kMs;) {
    const auto next = camera.next(into);
    if (!next) return false;
    if (*next == Next::kNew) return true;
  }
  return false;
}

/// The number of the picture that was taken then, and how far its time lies off that picture's.
std::int64_t number_at(TimeNs t_ns) { return std::llround(static_cast<double>(t_ns) / 33'333'333); }
double off_ns(TimeNs t_ns) { return static_cast<double>(t_ns - number_at(t_ns) * 33'333'333); }

TEST(LiveCamera, GivesEachPictureWithItsTimeOfCapture) {
  Desk desk;
  const auto camera = opened(desk);
  EXPECT_TRUE(camera->live());
  EXPECT_EQ(camera->size(), kSize);
  EXPECT_NEAR(camera->frame_s(), 1.0 / 30, 1e-4);
  Picture picture;
  for (int i = 0; i < 90; ++i) {
    ASSERT_TRUE(picture_of(*camera, desk, picture));
    const std::int64_t n = number_at(picture.t_ns);
    EXPECT_NEAR(off_ns(picture.t_ns), 0, 2e3);  // stamps have whole microseconds
    EXPECT_EQ(number_in(picture), n % 128);
  }
  EXPECT_EQ(camera->dropped(), 0);
  EXPECT_EQ(camera->warning(), "");
}

TEST(LiveCamera, TheNewestPictureAndACountOfTheOthers) {
  Desk desk;
  const auto camera = opened(desk);
  Picture picture;
  ASSERT_TRUE(picture_of(*camera, desk, picture));
  const int first = number_in(picture);
  desk.still_ns += 2 * 33'333'333;  // who takes pictures is slow
  ASSERT_TRUE(picture_of(*camera, desk, picture));
  EXPECT_EQ(number_in(picture), first + 2);
  EXPECT_EQ(camera->dropped(), 1);
  desk.cameras[0].loses = [](std::int64_t n) { return n % 3 == 0; };
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(picture_of(*camera, desk, picture));
    EXPECT_NE(number_in(picture) % 3, 0);
  }
  EXPECT_NEAR(static_cast<double>(camera->dropped()), 11, 1);
}

TEST(LiveCamera, StampsAtTheEndOfTheFrameAndNoStampsAtAll) {
  Desk desk;
  desk.cameras[0].stamps_at_end = true;
  desk.cameras[0].delay_ns = 50 * kMs;
  const auto at_end = opened(desk);
  Picture picture;
  ASSERT_TRUE(picture_of(*at_end, desk, picture));
  EXPECT_NEAR(off_ns(picture.t_ns), 0, 3e3);
  desk.cameras[1].stamps_monotonic = false;
  const auto unknown = opened(desk, "camera:2");
  ASSERT_TRUE(picture_of(*unknown, desk, picture));
  EXPECT_NEAR(off_ns(picture.t_ns - 20 * kMs), 0, 2e3);  // when it arrived
}

TEST(LiveCamera, DamagedPicturesAreLostNotGiven) {
  Desk desk;
  const std::string whole = jpeg();
  auto& fake = desk.cameras[0];
  fake.modes = {{V4L2_PIX_FMT_MJPEG, 64, 48, 30}};
  fake.bytes = [&](std::int64_t n, std::uint32_t) {
    std::string bytes = whole;
    std::mt19937 random(static_cast<unsigned>(n));
    if (n % 4 == 1) bytes.resize(random() % bytes.size());                                       // cut
    if (n % 4 == 2) bytes = bytes.substr(0, bytes.size() / 2) + bytes.substr(bytes.size() - 4);  // a hole
    if (n % 4 == 3)                                                                              // noise everywhere
      for (char& c : bytes) c = static_cast<char>(random());
    return bytes + std::string(100, '\0');
  };
  const auto camera = opened(desk);
  Picture picture, before;
  int given = 0;
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(picture_of(*camera, desk, picture));
    ++given;
    const std::int64_t n = number_at(picture.t_ns);
    EXPECT_EQ(n % 4, 0) << n;
    EXPECT_TRUE(std::equal(whole.begin(), whole.end(), picture.jpeg.begin(), picture.jpeg.end(), [](char a, std::uint8_t b) {
      return static_cast<std::uint8_t>(a) == b;
    })) << "as the camera sent it, without what fills the buffer";
  }
  EXPECT_NEAR(static_cast<double>(camera->dropped()), 3 * given, 4);
  fake.damaged = [](std::int64_t) { return true; };
  EXPECT_FALSE(picture_of(*camera, desk, picture));
  EXPECT_NE(camera->warning().find("camera:0 is away since"), std::string::npos) << camera->warning();
}

TEST(LiveCamera, ShortRawBuffersAndAWrongJpegSizeAreNoPictures) {
  Desk desk;
  desk.cameras[0].bytes = [](std::int64_t n, std::uint32_t) { return numbered(n, n % 2 == 0 ? kSize : Size{64, 47}); };
  const auto camera = opened(desk);
  Picture picture;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(picture_of(*camera, desk, picture));
    EXPECT_EQ(number_in(picture) % 2, 0);
  }
  auto& other = desk.cameras[1];
  other.modes = {{V4L2_PIX_FMT_MJPEG, 640, 480, 30}};
  other.bytes = [whole = jpeg()](std::int64_t, std::uint32_t) { return whole; };
  const auto large = opened(desk, "camera:2", {});
  EXPECT_FALSE(picture_of(*large, desk, picture));
  EXPECT_NE(large->warning().find("another size than the 640x480"), std::string::npos) << large->warning();
}

/// Left red, right blue in the numbers of BT.601: 81, 90, 240 and 41, 240, 110. Each second buffer lacks its last row of
/// colour.
TEST(LiveCamera, Nv12HasItsColours) {
  Desk desk;
  desk.cameras[0].modes = {{V4L2_PIX_FMT_NV12, 64, 48, 30}, {V4L2_PIX_FMT_MJPEG, 64, 48, 30}};
  desk.cameras[0].bytes = [](std::int64_t n, std::uint32_t) {
    constexpr int kStride = 64 + FakeV4l2::kNv12Padding;
    std::string bytes(std::size_t{kStride} * 72, '\0');
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 64; ++x) {
        const bool red = x < 32, first = x % 2 == 0;
        const int value = y < 48 ? (red ? 81 : 41) : first ? (red ? 90 : 240) : (red ? 240 : 110);
        bytes[static_cast<std::size_t>(y * kStride + x)] = static_cast<char>(value);
      }
    if (n % 2 == 1) bytes.resize(std::size_t{kStride} * 71);
    return bytes;
  };
  const auto camera = opened(desk);
  EXPECT_EQ(fourcc_text(desk.cameras[0].streamed()), "NV12");
  Picture picture;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(picture_of(*camera, desk, picture));
    EXPECT_EQ(number_at(picture.t_ns) % 2, 0);
    for (const int y : {0, 47}) {
      const Rgb8 red = picture.pixels.at(y, 10), blue = picture.pixels.at(y, 50);
      EXPECT_TRUE(red.r > 250 && red.g < 5 && red.b < 5) << int{red.r} << ' ' << int{red.g} << ' ' << int{red.b};
      EXPECT_TRUE(blue.r < 5 && blue.g < 5 && blue.b > 250) << int{blue.r} << ' ' << int{blue.g} << ' ' << int{blue.b};
    }
  }
}

TEST(LiveCamera, WhatCannotBeOpenedIsSaidInOneLine) {
  Desk desk;
  const auto error = [&](const std::string& name, const CameraWish& wish = kWish) {
    const auto camera = open_camera(desk.calls, name, wish);
    EXPECT_FALSE(camera);
    return camera ? std::string() : camera.error().what;
  };
  EXPECT_NE(error("camera:7").find("/dev/video7: no such camera"), std::string::npos);
  EXPECT_NE(error("camera:usb-9").find("on the bus: usb-0000:00:14.0-1, usb-0000:00:14.0-2"), std::string::npos);
  EXPECT_NE(error("camera:0", {.size = {800, 600}}).find("has no 800x600"), std::string::npos);
  desk.cameras[0].forced = {V4L2_PIX_FMT_YUYV, 320, 240, 30};
  EXPECT_NE(error("camera:0").find("asked for 64x48 it gives 320x240"), std::string::npos);
  desk.cameras[0].forced = {V4L2_PIX_FMT_H264, 64, 48, 30};
  EXPECT_NE(error("camera:0").find("asked for YUYV it gives H264"), std::string::npos) << error("camera:0");
  desk.cameras[0].forced = {};
  desk.cameras[0].no_room = 2;
  EXPECT_NE(error("camera:0").find("no bandwidth left"), std::string::npos);
  auto pair = open_cameras(desk.calls, "camera:2", "camera:usb-0000:00:14.0-2", kWish);
  ASSERT_FALSE(pair);
  EXPECT_NE(pair.error().what.find("both are /dev/video2"), std::string::npos) << pair.error().what;
  pair = open_cameras(desk.calls, "camera:2", "camera:0", kWish);
  ASSERT_FALSE(pair);
  EXPECT_NE(pair.error().what.find("start camera camera:0: the USB bus has no bandwidth left for two streams"),
            std::string::npos)
      << pair.error().what;
  desk.calls.open = [](const std::string&) { return errno = EACCES, -1; };
  EXPECT_NE(error("camera:0").find("sudo usermod -aG video"), std::string::npos);
  EXPECT_NE(find_cameras(desk.calls).error().what.find("sudo usermod -aG video"), std::string::npos);
  desk.calls.open = [](const std::string&) { return errno = ENOENT, -1; };
  EXPECT_NE(find_cameras(desk.calls).error().what.find("no camera found; plug one in"), std::string::npos);
}

TEST(LiveCamera, RawWhereTheBusHasRoomElseJpeg) {
  const auto streamed = [](Desk& desk, const CameraWish& wish) {
    const auto pair = open_cameras(desk.calls, "camera:0", "camera:2", wish);
    EXPECT_TRUE(pair) << pair.error().what;
    EXPECT_EQ(desk.cameras[0].streamed(), desk.cameras[1].streamed());
    return fourcc_text(desk.cameras[0].streamed());
  };
  Desk one_bus, two_buses, small, full;
  EXPECT_EQ(streamed(one_bus, {}), "MJPG");
  two_buses.cameras[1].bus = "usb-0000:05:00.0-1";
  EXPECT_EQ(streamed(two_buses, {}), "YUYV");
  EXPECT_EQ(streamed(small, kWish), "YUYV");
  full.cameras[1].no_room = 1;
  EXPECT_EQ(streamed(full, kWish), "MJPG");

  const auto found = find_cameras(one_bus.calls);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2u);
  EXPECT_EQ((*found)[1].path, "/dev/video2");
  EXPECT_EQ((*found)[1].modes.size(), 4u);
  EXPECT_EQ(*common_format((*found)[0], (*found)[1], {}), "MJPG");
  EXPECT_FALSE(common_format((*found)[0], (*found)[0], {}));
}

TEST(LiveCamera, BothLookAsTheLeftOneDoes) {
  Desk desk;
  auto& [left, right] = desk.cameras;
  right.controls[V4L2_CID_EXPOSURE_ABSOLUTE].default_value = 900;
  right.controls[V4L2_CID_GAIN].maximum = 30;
  right.controls.erase(V4L2_CID_WHITE_BALANCE_TEMPERATURE);
  const auto value = [](FakeV4l2& camera, std::uint32_t id) {
    const std::lock_guard lock(camera.mutex());
    return camera.controls[id].default_value;
  };
  const auto both = open_cameras(desk.calls, "camera:0", "camera:2", kWish);
  ASSERT_TRUE(both) << both.error().what;
  const auto run = [&](double seconds) {
    Picture picture;
    for (const TimeNs start = desk.now(); static_cast<double>(desk.now() - start) < seconds * 1e9;)
      for (const auto& camera : *both) ASSERT_TRUE(camera->next(picture));
  };
  run(0.5);
  EXPECT_EQ(value(left, V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
  left.controls[V4L2_CID_EXPOSURE_ABSOLUTE].default_value = 333;  // what its automatic comes to
  run(1.5);
  for (FakeV4l2* camera : {&left, &right}) {
    EXPECT_EQ(value(*camera, V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
    EXPECT_EQ(value(*camera, V4L2_CID_AUTO_WHITE_BALANCE), 0);
    EXPECT_EQ(value(*camera, V4L2_CID_EXPOSURE_ABSOLUTE), 333);
  }
  EXPECT_EQ((*both)[0]->warning(), "");
  EXPECT_NE((*both)[1]->warning().find("gain 30 instead of 40, no white balance"), std::string::npos) << (*both)[1]->warning();
  // A camera that comes back forgot everything, and is told again.
  desk.plugged[1] = false;
  run(0.5);
  right.controls[V4L2_CID_EXPOSURE_AUTO].default_value = V4L2_EXPOSURE_APERTURE_PRIORITY;
  right.controls[V4L2_CID_EXPOSURE_ABSOLUTE].default_value = 100;
  desk.plugged[1] = true;
  run(1);
  EXPECT_EQ(value(right, V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(value(right, V4L2_CID_EXPOSURE_ABSOLUTE), 333);
}

TEST(LiveCamera, BackAfterAThousandTimesUnplugged) {
  Desk desk;
  const auto camera = opened(desk);
  Picture picture;
  ASSERT_TRUE(picture_of(*camera, desk, picture));
  TimeNs longest_ns = 0, last_ns = 0;
  for (int i = 0; i < 1000; ++i) {
    desk.plugged[0] = false;
    desk.still_ns += i % 50 * kMs;
    for (int k = 0; k < 1 + i % 3; ++k) {
      const auto next = camera->next(picture);
      ASSERT_TRUE(next);
      ASSERT_EQ(*next, Next::kNothing);
    }
    ASSERT_NE(camera->warning().find("is away since"), std::string::npos) << camera->warning();
    if (i % 2 == 0) desk.paths[0] = i % 4 == 0 ? "/dev/video4" : "/dev/video0";  // the kernel gives it another number
    desk.plugged[0] = true;
    const TimeNs back_ns = desk.now();
    ASSERT_TRUE(picture_of(*camera, desk, picture)) << i;
    ASSERT_GT(picture.t_ns, last_ns);
    last_ns = picture.t_ns;
    longest_ns = std::max(longest_ns, desk.now() - back_ns);
  }
  EXPECT_NE(camera->warning().find("camera:0 is back since"), std::string::npos) << camera->warning();
  EXPECT_LT(longest_ns, 500 * kMs);
}

TEST(LiveCamera, AnotherCameraInItsPlaceIsNotTaken) {
  Desk desk;
  const auto camera = opened(desk);
  Picture picture;
  ASSERT_TRUE(picture_of(*camera, desk, picture));
  desk.plugged[0] = false;
  ASSERT_EQ(*camera->next(picture), Next::kNothing);
  desk.cameras[0].name = "Another webcam";
  desk.plugged[0] = true;
  EXPECT_FALSE(picture_of(*camera, desk, picture));
  desk.cameras[0].name = "Fake webcam";
  EXPECT_TRUE(picture_of(*camera, desk, picture));
}

TEST(LiveCamera, OneThatFallsSilentIsOpenedAgain) {
  Desk desk;
  const auto camera = opened(desk);
  Picture picture;
  ASSERT_TRUE(picture_of(*camera, desk, picture));
  std::int64_t silent_until = 0;
  desk.cameras[0].loses = [&](std::int64_t n) { return n < silent_until; };
  silent_until = 45 + desk.now() / 33'333'333;  // a second and a half
  const TimeNs start = desk.now();
  ASSERT_TRUE(picture_of(*camera, desk, picture));
  EXPECT_LT(desk.now() - start, 2000 * kMs);
  EXPECT_NE(camera->warning().find("is back since"), std::string::npos) << camera->warning();
}

/// Bytes right before a page that nobody may read.
class Guarded {
 public:
  explicit Guarded(std::size_t bytes) : bytes_(bytes) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    mapped_ = (bytes + page - 1) / page * page + page;
    start_ = static_cast<char*>(mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    EXPECT_EQ(mprotect(start_ + mapped_ - page, page, PROT_NONE), 0);
    data_ = start_ + mapped_ - page - bytes;
    std::memset(data_, 0x55, bytes);
  }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;
  ~Guarded() { munmap(start_, mapped_); }
  char* data() const { return data_; }
  std::string_view bytes() const { return {data_, bytes_}; }

 private:
  std::size_t bytes_, mapped_;
  char *start_, *data_;
};

std::size_t raw_bytes(std::uint32_t fourcc, Size size) {
  const auto w = static_cast<std::size_t>(size.width), h = static_cast<std::size_t>(size.height);
  return fourcc == fourcc_of("NV12") ? (w + 1) / 2 * 2 * (h + (h + 1) / 2) : 2 * w * h;
}

/// Whatever the size, no byte behind a driver's buffer is read; and the same pixels come out wherever it lies.
TEST(CameraBuffers, AreNotReadBeyondTheirEnd) {
  constexpr Size kSizes[] = {{424, 240}, {848, 480}, {1080, 1920}, {320, 240}, {2, 2}};
  for (const auto fourcc : {fourcc_of("YUYV"), fourcc_of("UYVY"), fourcc_of("NV12")}) {
    std::vector<Size> sizes(std::begin(kSizes), std::end(kSizes));
    for (int width = 1; width < 140; ++width) sizes.push_back({width, 3 + width % 2});
    CameraDecoder decoder;
    for (const Size size : sizes) {
      const Guarded guarded(raw_bytes(fourcc, size));
      std::string elsewhere(guarded.bytes());
      Picture picture, other;
      const CameraFormat format{.fourcc = fourcc, .size = size};
      ASSERT_EQ(decoder.decode(format, guarded.bytes(), picture), CameraDecoder::Outcome::kWhole) << size.width;
      ASSERT_EQ(decoder.decode(format, elsewhere, other), CameraDecoder::Outcome::kWhole);
      ASSERT_EQ(picture.pixels.at(size.height - 1, size.width - 1), other.pixels.at(size.height - 1, size.width - 1));
    }
  }
}

/// What every conversion's input has behind it is enough for libswscale, of any width.
TEST(CameraBuffers, ThePaddingIsEnough) {
  for (const AVPixelFormat kind : {AV_PIX_FMT_YUYV422, AV_PIX_FMT_UYVY422, AV_PIX_FMT_NV12})
    for (int width = 2; width < 300; ++width) {
      constexpr int kRows = 4;
      const bool nv12 = kind == AV_PIX_FMT_NV12;
      const int stride = nv12 ? (width + 1) / 2 * 2 : 2 * width;
      const Guarded guarded(static_cast<std::size_t>(stride * (nv12 ? kRows * 3 / 2 : kRows)) + av::ToRgb::kReadBeyond);
      const av::DecodedFrame frame(av_frame_alloc());
      frame->format = kind;
      frame->width = width;
      frame->height = kRows;
      frame->data[0] = reinterpret_cast<std::uint8_t*>(guarded.data());
      frame->data[1] = nv12 ? frame->data[0] + std::ptrdiff_t{stride} * kRows : nullptr;
      frame->linesize[0] = stride;
      frame->linesize[1] = nv12 ? stride : 0;
      Image<Rgb8> picture;
      ASSERT_TRUE(av::ToRgb().convert(*frame, picture));
    }
}

}  // namespace
}  // namespace duo
