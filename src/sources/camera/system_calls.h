// The system as a camera sees it, as a table: tests put cameras of their own behind it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "duoptic/frame.h"

namespace duo {

/// Each call as in libc, with errno, but where a comment says otherwise.
struct SystemCalls {
  std::function<int(const std::string& path)> open;  // to read and write, never blocking
  std::function<int(int fd)> close;
  std::function<int(int fd, unsigned long request, void* argument)> ioctl;
  std::function<void*(int fd, std::size_t bytes, std::int64_t offset)> map;  // shared; nullptr when it fails
  std::function<int(void* start, std::size_t bytes)> unmap;
  std::function<int(int fd, int timeout_ms)> poll;           // the events of one fd (-1: waits only), 0 after the time, or -1
  std::function<std::string(const std::string& path)> read;  // the first line of a file of the system; empty without one
  std::function<TimeNs()> now_ns;                            // the clock of the drivers' stamps
};

/// Linux itself.
const SystemCalls& linux_calls();

}  // namespace duo
