#include "sources/camera/system_calls.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/clock.h"

namespace duo {
namespace {

std::string first_line(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return {};
  char text[256];
  const ssize_t bytes = ::read(fd, text, sizeof text);
  ::close(fd);
  const std::string all(text, bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
  return all.substr(0, all.find('\n'));
}

}  // namespace

const SystemCalls& linux_calls() {
  static const SystemCalls calls = {
      .open = [](const std::string& path) { return ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC); },
      .close = [](int fd) { return ::close(fd); },
      .ioctl = [](int fd, unsigned long request, void* argument) { return ::ioctl(fd, request, argument); },
      .map =
          [](int fd, std::size_t bytes, std::int64_t offset) {
            void* start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, static_cast<off_t>(offset));
            return start == MAP_FAILED ? nullptr : start;
          },
      .unmap = [](void* start, std::size_t bytes) { return ::munmap(start, bytes); },
      .poll =
          [](int fd, int timeout_ms) {
            pollfd one{fd, POLLIN, 0};
            const int ready = ::poll(&one, fd < 0 ? 0 : 1, timeout_ms);
            return ready > 0 ? one.revents : ready;
          },
      .read = first_line,
      .now_ns = [] { return TimeNs{wall_ns()}; },
  };
  return calls;
}

}  // namespace duo
