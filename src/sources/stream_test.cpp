// A stream as a network camera sends it, over the loopback: its pictures come, one that breaks off is opened again, and nothing
// waits for one that hangs.
#include "sources/stream.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "sources/gst_process.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace std::chrono_literals;

/// Sends `pictures` JPEGs a connection, then closes it, or says nothing any more.
class NetworkCamera {
 public:
  explicit NetworkCamera(int pictures, bool hangs) : pictures_(pictures), hangs_(hangs) {
    auto encoder = test::make_encoder(AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P);
    encoder.encode(test::pattern(AV_PIX_FMT_YUVJ420P, 0).get(),
                   [&](AVPacket& p) { jpeg_.assign(reinterpret_cast<char*>(p.data), static_cast<std::size_t>(p.size)); });
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(listening_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(listening_, 4), 0);
    EXPECT_EQ(getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    name_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/stream";
    thread_ = std::thread([this] { serve(); });
  }
  ~NetworkCamera() {
    stopped_ = true;
    thread_.join();
    close(listening_);
  }
  const std::string& name() const { return name_; }
  int connections() const { return connections_; }

 private:
  void serve() {
    while (!stopped_) {
      pollfd one{listening_, POLLIN, 0};
      if (poll(&one, 1, 50) <= 0) continue;
      const int client = accept(listening_, nullptr, nullptr);
      ++connections_;
      char request[4096];
      bool open = recv(client, request, sizeof request, 0) > 0 &&
                  put(client, "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=cut\r\n\r\n");
      for (int i = 0; i < pictures_ && open && !stopped_; ++i) {
        open = put(client, "--cut\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg_.size()) + "\r\n\r\n" +
                               jpeg_ + "\r\n");
        std::this_thread::sleep_for(10ms);
      }
      while (hangs_ && !stopped_) std::this_thread::sleep_for(10ms);
      close(client);
    }
  }
  static bool put(int client, const std::string& bytes) {
    return send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }

  int pictures_;
  bool hangs_;
  std::string jpeg_, name_;
  int listening_ = socket(AF_INET, SOCK_STREAM, 0);
  std::atomic<int> connections_ = 0;
  std::atomic<bool> stopped_ = false;
  std::thread thread_;
};

int pictures_within(Source& stream, std::chrono::milliseconds time, int most) {
  Picture picture;
  int given = 0;
  for (const auto start = std::chrono::steady_clock::now(); std::chrono::steady_clock::now() - start < time && given < most;) {
    const auto next = stream.next(picture);
    EXPECT_TRUE(next);
    given += next && *next == Next::kNew;
  }
  return given;
}

TEST(Stream, BreaksOffAndIsOpenedAgain) {
  const NetworkCamera camera(40, false);
  const auto stream = open_stream(camera.name());
  ASSERT_TRUE(stream) << stream.error().what;
  EXPECT_EQ((*stream)->size(), test::kSize);
  EXPECT_TRUE((*stream)->live());
  while (camera.connections() < 2) ASSERT_GT(pictures_within(**stream, 10s, 1), 0);
  EXPECT_EQ(pictures_within(**stream, 10s, 5), 5);
}

TEST(Stream, NothingWaitsForOneThatHangs) {
  const NetworkCamera camera(20, true);
  auto stream = open_stream(camera.name());
  ASSERT_TRUE(stream) << stream.error().what;
  while (pictures_within(**stream, 100ms, 1) > 0) continue;
  const auto start = std::chrono::steady_clock::now();
  stream->reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
}

TEST(Stream, NoneThereIsSaidAtOnce) {
  const auto stream = open_stream("http://127.0.0.1:1/nothing");
  ASSERT_FALSE(stream);
  EXPECT_NE(stream.error().what.find("cannot open stream http://127.0.0.1:1/nothing"), std::string::npos);
}

TEST(Stream, PipelineIsSplitAsAShellDoes) {
  EXPECT_EQ(words_of("v4l2src  device=/dev/video0 ! video/x-raw,width=640"),
            (std::vector<std::string>{"v4l2src", "device=/dev/video0", "!", "video/x-raw,width=640"}));
  EXPECT_EQ(words_of(" filesrc location=\"a b.mp4\" name='it is' "),
            (std::vector<std::string>{"filesrc", "location=a b.mp4", "name=it is"}));
  EXPECT_TRUE(words_of("  ").empty());
}

/// A gst-launch-1.0 of our own, first in PATH: a shell script.
class Gst : public ::testing::Test {
 protected:
  void SetUp() override { setenv("PATH", ((folder_ / "").string() + ":" + path_).c_str(), 1); }
  void TearDown() override { setenv("PATH", path_.c_str(), 1); }
  void launch(const std::string& script) {
    const auto file = folder_ / "gst-launch-1.0";
    test::put(file, "#!/bin/sh\n" + script);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  std::string path_ = std::getenv("PATH");
  test::TempFolder folder_;
};

// Two pictures of 2x1 pixels, Y, then U and V: white and black, then gray twice.
constexpr char kTwoPictures[] =
    "printf 'YUV4MPEG2 W2 H1 F15:1 Ip A1:1 "
    "C444\\nFRAME\\n\\353\\020\\200\\200\\200\\200FRAME\\n\\176\\176\\200\\200\\200\\200'\n";

TEST_F(Gst, PicturesComeAndOneThatHangsIsEnded) {
  const std::string words = (folder_ / "words").string();
  launch("echo \"$@\" >" + words + "\n" + kTwoPictures + "exec sleep 1000\n");
  auto stream = open_stream("gst:fakesrc name=\"a b\" ! appsink drop=true");
  ASSERT_TRUE(stream) << stream.error().what;
  EXPECT_EQ((*stream)->size(), (Size{2, 1}));
  EXPECT_NEAR((*stream)->frame_s(), 1.0 / 15, 1e-9);
  Picture picture;
  while (picture.sequence < 1) ASSERT_TRUE((*stream)->next(picture));
  for (int x = 0; x < 2; ++x) EXPECT_NEAR(picture.pixels.at(0, x).g, 128, 1);
  EXPECT_EQ(test::bytes_of(words),
            "-q fakesrc name=a b ! videoconvert ! video/x-raw,format=Y444,colorimetry=bt601 ! y4menc ! fdsink fd=1\n");
  const auto start = std::chrono::steady_clock::now();
  stream->reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 1s);
}

TEST_F(Gst, OneThatEndsIsStartedAgain) {
  launch(std::string(kTwoPictures) + "sleep 0.1\n");
  const auto stream = open_stream("gst:fakesrc");
  ASSERT_TRUE(stream) << stream.error().what;
  Picture picture;
  while (picture.sequence < 3) ASSERT_TRUE((*stream)->next(picture));  // of the second time
}

TEST_F(Gst, WhatItSaysIsPassedOn) {
  launch(
      "echo 'Use Windows high-resolution clock' >&2; echo 'WARNING: erroneous pipeline: no element \"nosuch\"' >&2; exit 1\n");
  const auto stream = open_stream("gst:nosuch ! appsink");
  ASSERT_FALSE(stream);
  EXPECT_EQ(stream.error().what.find("cannot open stream gst:nosuch ! appsink: erroneous pipeline: no element \"nosuch\"; "),
            0u)
      << stream.error().what;
  std::filesystem::remove(folder_ / "gst-launch-1.0");
  setenv("PATH", (folder_ / "").c_str(), 1);
  EXPECT_NE(open_stream("gst:fakesrc").error().what.find("install gstreamer1.0-tools"), std::string::npos);
  EXPECT_NE(open_stream("gst:").error().what.find("it is empty"), std::string::npos);
}

TEST(Stream, GstreamerItself) {
  if (std::system("gst-inspect-1.0 --exists y4menc >/dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no GStreamer";
  const auto stream =
      open_stream("gst:videotestsrc is-live=true pattern=red ! video/x-raw,width=64,height=48,framerate=30/1 ! appsink");
  ASSERT_TRUE(stream) << stream.error().what;
  EXPECT_EQ((*stream)->size(), (Size{64, 48}));
  Picture picture;
  while (picture.sequence < 5) ASSERT_TRUE((*stream)->next(picture));
  EXPECT_NEAR(picture.pixels.at(20, 30).r, 255, 2);
  EXPECT_NEAR(picture.pixels.at(20, 30).g, 0, 2);
  EXPECT_NEAR(picture.pixels.at(20, 30).b, 0, 2);
}

}  // namespace
}  // namespace duo
