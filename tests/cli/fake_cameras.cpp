// Preloaded before a program, this puts two webcams at /dev/video0 and /dev/video2 that show what lies in the folder named by
// DUO_FAKE_FOLDER: left.yuyv and right.yuyv, 320x240. The second one is plugged in as long as there is no file `unplugged`.
#include <fcntl.h>
#include <stdarg.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

#include "tests/fake_v4l2.h"

namespace {

using duo::test::FakeV4l2;

constexpr std::int64_t kSkew_ns = 5'000'000;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Webcams {
 public:
  Webcams() {
    const char* named = std::getenv("DUO_FAKE_FOLDER");
    const std::string folder = named != nullptr ? named : ".";
    for (std::size_t i = 0; i < 2; ++i) {
      FakeV4l2& camera = cameras_[i];
      camera.bus = "usb-0000:00:14.0-" + std::to_string(i + 1);
      camera.phase_ns = i == 0 ? 0 : kSkew_ns;
      camera.modes = {{V4L2_PIX_FMT_YUYV, 320, 240, 30}, {V4L2_PIX_FMT_YUYV, 640, 480, 30}, {V4L2_PIX_FMT_MJPEG, 640, 480, 30}};
      camera.bytes = [content = bytes_of(folder + (i == 0 ? "/left.yuyv" : "/right.yuyv"))](std::int64_t, std::uint32_t) {
        return content;
      };
    }
    cameras_[1].plugged = [gone = folder + "/unplugged"] { return syscall(SYS_access, gone.c_str(), F_OK) != 0; };
  }

  /// The camera behind an open file; none for every other file.
  FakeV4l2* of(int fd) { return fd >= 0 && fd < kMostFiles ? open_[static_cast<std::size_t>(fd)].load() : nullptr; }

  int open(const std::string& path) {
    FakeV4l2& camera = cameras_[path == "/dev/video0" ? 0 : 1];
    if ((path != "/dev/video0" && path != "/dev/video2") || !camera.open()) return errno = ENOENT, -1;
    const int fd = memory_file("");
    open_[static_cast<std::size_t>(fd)] = &camera;
    return fd;
  }
  int close(int fd) {
    if (FakeV4l2* camera = of(fd)) {
      open_[static_cast<std::size_t>(fd)] = nullptr;
      camera->close();
    }
    return static_cast<int>(syscall(SYS_close, fd));
  }

  /// A file that holds this text.
  static int memory_file(const std::string& text) {
    const int fd = static_cast<int>(syscall(SYS_memfd_create, "webcam", 0));
    if (fd < 0 || fd >= kMostFiles) std::abort();
    if (write(fd, text.data(), text.size()) < 0) std::abort();
    lseek(fd, 0, SEEK_SET);
    return fd;
  }

  void* map(FakeV4l2& camera, std::int64_t offset) {
    void* start = camera.map(offset);
    const std::lock_guard lock(mutex_);
    mapped_.insert(start);
    return start;
  }
  bool unmap(void* start) {
    const std::lock_guard lock(mutex_);
    return mapped_.erase(start) != 0;
  }

 private:
  static constexpr int kMostFiles = 1024;
  std::array<FakeV4l2, 2> cameras_;
  std::array<std::atomic<FakeV4l2*>, kMostFiles> open_{};
  std::mutex mutex_;
  std::set<void*> mapped_;
};

std::atomic<bool> used = false;  // before the first camera every call is the kernel's
Webcams& webcams() {
  static Webcams all;
  used = true;
  return all;
}

int open_any(const char* path, int flags, int mode) {
  const std::string name = path;
  if (name.rfind("/dev/video", 0) == 0) return webcams().open(name);
  if (name.rfind("/sys/class/video4linux/", 0) == 0)
    return Webcams::memory_file(name.ends_with("speed") ? "480\n" : name.find("video0") != std::string::npos ? "L1\n" : "R1\n");
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

int mode_of(int flags, va_list arguments) { return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, int) : 0; }

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_any(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_any(path, flags, mode);
}

int close(int fd) { return used ? webcams().close(fd) : static_cast<int>(syscall(SYS_close, fd)); }

int ioctl(int fd, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  FakeV4l2* camera = used ? webcams().of(fd) : nullptr;
  if (camera != nullptr) return camera->ioctl(request, argument, now_ns());
  return static_cast<int>(syscall(SYS_ioctl, fd, request, argument));
}

void* mmap(void* start, size_t bytes, int protection, int flags, int fd, off_t offset) {
  FakeV4l2* camera = used ? webcams().of(fd) : nullptr;
  if (camera != nullptr) return webcams().map(*camera, offset);
  return reinterpret_cast<void*>(syscall(SYS_mmap, start, bytes, protection, flags, fd, offset));
}
void* mmap64(void* start, size_t bytes, int protection, int flags, int fd, off_t offset) {
  return mmap(start, bytes, protection, flags, fd, offset);
}
int munmap(void* start, size_t bytes) {
  if (used && webcams().unmap(start)) return 0;
  return static_cast<int>(syscall(SYS_munmap, start, bytes));
}

int poll(pollfd* files, nfds_t count, int timeout_ms) {
  FakeV4l2* camera = used && count == 1 ? webcams().of(files->fd) : nullptr;
  if (camera == nullptr) return static_cast<int>(syscall(SYS_poll, files, count, timeout_ms));
  const std::int64_t until = now_ns() + timeout_ms * std::int64_t{1'000'000};
  while (true) {
    files->revents = camera->events(now_ns());
    if (files->revents != 0) return 1;
    if (now_ns() >= until) return 0;
    timespec step{0, 1'000'000};
    nanosleep(&step, nullptr);
  }
}

}  // extern "C"
