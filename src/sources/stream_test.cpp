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
#include <thread>

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
    given += next && *next == Next::kPicture;
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

}  // namespace
}  // namespace duo
