#include "sinks/osc_target.h"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

namespace duo {
namespace {

Error cannot_send(const std::string& target, const std::string& why) {
  return {ErrorCode::kBadInput, fmt::format("cannot send to '{}': {}", target, why)};
}

struct FreeAddresses {
  void operator()(addrinfo* p) const { freeaddrinfo(p); }
};

}  // namespace

Result<OscTarget> OscTarget::open(const std::string& target) {
  const std::size_t colon = target.rfind(':');
  const std::string port = colon == std::string::npos ? "" : target.substr(colon + 1);
  std::string host = target.substr(0, std::min(colon, target.size()));
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);  // IPv6
  int number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (host.empty() || error != std::errc() || end != port.data() + port.size() || number < 1 || number > 65535)
    return cannot_send(target, "give HOST:PORT, like 127.0.0.1:39539");
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (const int e = getaddrinfo(host.c_str(), port.c_str(), &hints, &found); e != 0)
    return cannot_send(target, fmt::format("{}; check the host's name", gai_strerror(e)));
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(found);
  std::string why;
  for (const addrinfo* a = found; a != nullptr; a = a->ai_next) {
    OscTarget out(::socket(a->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, a->ai_protocol));
    if (out.fd_ >= 0 && ::connect(out.fd_, a->ai_addr, a->ai_addrlen) == 0) return out;
    why = std::strerror(errno);
  }
  return cannot_send(target, why);
}

OscTarget::OscTarget(OscTarget&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), dropped_(other.dropped_), bytes_(std::move(other.bytes_)) {}

OscTarget::~OscTarget() {
  if (fd_ >= 0) ::close(fd_);
}

void OscTarget::send(const OscBundle& bundle) {
  std::size_t size = lo_bundle_length(bundle.get());
  bytes_.resize(size);
  lo_bundle_serialise(bundle.get(), bytes_.data(), &size);
  // A connected socket tells of an earlier packet that found no listener first, and has then not sent this one.
  ssize_t sent = ::send(fd_, bytes_.data(), size, 0);
  if (sent < 0 && errno == ECONNREFUSED) sent = ::send(fd_, bytes_.data(), size, 0);
  if (sent < 0 && errno != ECONNREFUSED) ++dropped_;
}

}  // namespace duo
