// Servers that mean harm: whatever they answer, the tool connects to nothing but the address that it was given, binds nothing,
// and ends.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <atomic>
#include <functional>
#include <set>

#include "duoptic/rig.h"
#include "duoptic/synthetic.h"
#include "process.h"
#include "tool.h"

namespace duo {
namespace {

using test::bytes_of;
using test::ToolProcess;

/// A server on the loopback that answers whatever it is asked.
class Server {
 public:
  explicit Server(std::function<std::string(const std::string& request, const Server&)> answer) : answer_(std::move(answer)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(listening_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(listening_, 16), 0);
    EXPECT_EQ(getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~Server() {
    stopped_ = true;
    thread_.join();
    close(listening_);
  }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  int connections() const { return connections_; }

 private:
  void serve() {
    while (!stopped_) {
      pollfd one{listening_, POLLIN, 0};
      if (poll(&one, 1, 20) <= 0) continue;
      const int client = accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
      ++connections_;
      char request[4096];
      const ssize_t asked = recv(client, request, sizeof request, 0);
      const std::string answer = answer_({request, static_cast<std::size_t>(std::max<ssize_t>(asked, 0))}, *this);
      for (std::size_t done = 0; done < answer.size() && !stopped_;) {
        const ssize_t n = send(client, answer.data() + done, answer.size() - done, MSG_NOSIGNAL);
        if (n <= 0) break;
        done += static_cast<std::size_t>(n);
      }
      shutdown(client, SHUT_WR);
      for (int i = 0; i < 20 && recv(client, request, sizeof request, MSG_DONTWAIT) != 0 && !stopped_; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      close(client);
    }
  }

  std::function<std::string(const std::string&, const Server&)> answer_;
  int listening_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), port_ = 0;
  std::atomic<int> connections_ = 0;
  std::atomic<bool> stopped_ = false;
  std::thread thread_;
};

std::string http(const std::string& kind, const std::string& body) {
  return "HTTP/1.1 200 OK\r\nConnection: close\r\nContent-Type: " + kind +
         "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

struct Attack {
  std::string name;
  std::string scheme = "http";
  std::function<std::string(const std::string& elsewhere)> answer;
};

const std::vector<Attack>& attacks() {
  static const std::vector<Attack> all = {
      {"session description", "http",
       [](const std::string&) {
         return http("application/sdp",
                     "v=0\r\no=- 0 0 IN IP4 0.0.0.0\r\ns=x\r\nc=IN IP4 0.0.0.0\r\nt=0 0\r\nm=video 50440 RTP/AVP 26\r\n");
       }},
      {"live play list", "http",
       [](const std::string& elsewhere) {
         return http("application/vnd.apple.mpegurl",
                     "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nhttp://" + elsewhere + "/a.ts\n#EXT-X-ENDLIST\n");
       }},
      {"dash", "http",
       [](const std::string& elsewhere) {
         return http("application/dash+xml",
                     "<?xml version=\"1.0\"?><MPD xmlns=\"urn:mpeg:dash:schema:mpd:2011\" type=\"static\" "
                     "mediaPresentationDuration=\"PT9S\"><BaseURL>http://" +
                         elsewhere +
                         "/</BaseURL><Period><AdaptationSet mimeType=\"video/mp4\"><Representation id=\"1\" bandwidth=\"1\">"
                         "<BaseURL>a.mp4</BaseURL></Representation></AdaptationSet></Period></MPD>");
       }},
      {"list of files", "http",
       [](const std::string& elsewhere) {
         return http("text/plain", "ffconcat version 1.0\nfile http://" + elsewhere + "/a.ts\n");
       }},
      {"sent elsewhere", "http",
       [](const std::string& elsewhere) {
         return "HTTP/1.1 302 Found\r\nLocation: http://" + elsewhere + "/a.mjpg\r\nContent-Length: 0\r\n\r\n";
       }},
      {"sent elsewhere by rtsp", "rtsp",
       [](const std::string& elsewhere) {
         return "RTSP/1.0 302 Found\r\nCSeq: 1\r\nLocation: rtsp://" + elsewhere + "/a\r\n\r\n";
       }},
      {"sent from rtsp to udp", "rtsp",
       [](const std::string&) {
         return std::string("RTSP/1.0 302 Found\r\nCSeq: 1\r\nLocation: udp://0.0.0.0:50442\r\n\r\n");
       }},
      {"nonsense", "http",
       [](const std::string&) {
         std::string bytes;
         for (unsigned i = 0, x = 1; i < 300'000; ++i) bytes += static_cast<char>((x = x * 1664525 + 1013904223) >> 24);
         return http("image/jpeg", bytes);
       }},
      {"nothing", "http", [](const std::string&) { return std::string(); }},
  };
  return all;
}

class Hostile : public ::testing::TestWithParam<Attack> {};

TEST_P(Hostile, OnlyWhatIsNamedIsConnectedTo) {
  const test::TempFolder folder;
  const Server elsewhere([](const std::string&, const Server&) { return http("text/plain", "gotcha"); });
  const Server named([&](const std::string&, const Server&) { return GetParam().answer(elsewhere.address()); });
  const std::string url = GetParam().scheme + "://" + named.address() + "/pictures";
  const std::string select = " --select hand=16,10 --select elbow=16,7 --select shoulder=16,5 --rig rig.json";
  ASSERT_TRUE(save_rig(synthetic_rig({.size = {64, 48}}), folder / "rig.json"));
  for (const std::string& command : {"record " + url + " -o r.mkv --seconds 1", "play " + url,
                                     "view " + url, "track " + url + " " + url + select}) {
    SCOPED_TRACE(command);
    std::filesystem::remove(folder / "log");
    ToolProcess tool(
        folder / "", command,
        {.environment = {
             {"LD_PRELOAD", DUO_FAULTS_LIBRARY}, {"DUO_FAULTS_LOG", folder / "log"}, {"http_proxy", ""}, {"DISPLAY", ""}}});
    const int exit = tool.end();
    EXPECT_EQ(exit, test::kInput) << bytes_of(folder / "stderr.txt");
    std::istringstream log(bytes_of(folder / "log"));
    for (std::string line; std::getline(log, line);) EXPECT_EQ(line, "connect " + named.address());
    EXPECT_FALSE(std::filesystem::exists(folder / "r.mkv") || std::filesystem::exists(folder / "out"));
  }
  EXPECT_EQ(elsewhere.connections(), 0);
  EXPECT_GT(named.connections(), 0);
}

INSTANTIATE_TEST_SUITE_P(Servers, Hostile, ::testing::ValuesIn(attacks()), [](const auto& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

/// A picture without an end is not collected without one.
TEST(HostileStream, APictureHasASize) {
  const test::TempFolder folder;
  for (const char* head : {"Content-Type: image/jpeg\r\n\r\n\xff\xd8",
                           "Content-Type: multipart/x-mixed-replace; boundary=cut\r\n\r\n--cut\r\nContent-Type: image/jpeg\r\n"
                           "Content-Length: 1000000000\r\n\r\n\xff\xd8"}) {
    const Server server(
        [&](const std::string&, const Server&) { return "HTTP/1.0 200 OK\r\n" + (head + std::string(400 << 20, '\0')); });
    ToolProcess tool(folder / "", "record http://" + server.address() + "/a -o r.mkv --seconds 1", {});
    EXPECT_EQ(tool.end(), test::kInput) << bytes_of(folder / "stderr.txt");
    EXPECT_LT(tool.most_memory_mb(), 250) << head;
  }
}

}  // namespace
}  // namespace duo
