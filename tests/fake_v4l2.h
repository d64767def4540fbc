// A camera as the kernel shows it, made up: answers the calls of V4L2 on a clock that it is given. Behind a table of system
// calls in unit tests, and behind libc itself in a preloaded library.
#pragma once

#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace duo::test {

/// A picture is taken every frame_ns from phase_ns on, and delivered delay_ns later. What can go wrong is a member to set.
///
/// Threads  any; members are set before the first call or under mutex()
class FakeV4l2 {
 public:
  struct Mode {
    std::uint32_t fourcc;
    std::uint32_t width, height;
    std::uint32_t hz;
  };
  std::string name = "Fake webcam", bus = "usb-0000:00:14.0-1", serial = "A1";
  std::vector<Mode> modes;
  std::int64_t frame_ns = 33'333'333, phase_ns = 0, delay_ns = 20'000'000;
  bool stamps_at_end = false;                                     // of the frame, instead of the start of exposure
  bool stamps_monotonic = true;                                   // else of a clock that nobody knows
  std::function<std::int64_t(std::int64_t)> jitter_ns;            // added to the stamp of picture n
  std::function<bool(std::int64_t)> loses;                        // picture n never comes
  std::function<std::string(std::int64_t, std::uint32_t)> bytes;  // of picture n in a format
  std::function<bool(std::int64_t)> damaged;                      // flagged so by the driver
  std::map<std::uint32_t, v4l2_queryctrl> controls;               // default_value is the value
  Mode forced{};                                                  // S_FMT gives this instead of what it was asked for
  int no_room = 0;                                                // STREAMON fails with ENOSPC for raw (1) or all (2) formats
  std::function<bool()> plugged = [] { return true; };

  std::mutex& mutex() { return mutex_; }
  int opens = 0, closes = 0, maps = 0, unmaps = 0;   // must be even at the end
  static constexpr std::uint32_t kNv12Padding = 16;  // bytes after each row
  std::uint32_t streamed() const { return format_.fourcc; }

  bool open() {
    const std::lock_guard lock(mutex_);
    if (!plugged()) return false;
    ++opens;
    if (!gone_) return true;
    gone_ = running_ = false;  // a new device, as the kernel sees it
    buffers_.clear();
    queued_.clear();
    filled_.clear();
    return true;
  }
  void close() {
    const std::lock_guard lock(mutex_);
    ++closes;
  }
  void* map(std::int64_t offset) {
    const std::lock_guard lock(mutex_);
    ++maps;
    return buffers_[static_cast<std::size_t>(offset / kBufferStep)].memory.data();
  }
  void unmap() {
    const std::lock_guard lock(mutex_);
    ++unmaps;
  }
  /// As ioctl(), at this moment; errno is set when it gives -1.
  int ioctl(unsigned long request, void* argument, std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    const int error = answer(request, argument, now_ns);
    if (error != 0) errno = error;
    return error == 0 ? 0 : -1;
  }
  /// What poll() would say now.
  short events(std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    if (left()) return POLLERR | POLLHUP;
    deliver(now_ns);
    return filled_.empty() ? 0 : POLLIN;
  }
  /// When the next picture will be there.
  std::int64_t next_ns() {
    const std::lock_guard lock(mutex_);
    return phase_ns + next_ * frame_ns + delay_ns;
  }

 private:
  static constexpr std::int64_t kBufferStep = 1 << 24;
  struct Buffer {
    std::vector<char> memory;
    v4l2_buffer filled{};
  };

  /// A camera that was pulled out stays gone for those who had opened it.
  bool left() { return gone_ = gone_ || !plugged(); }

  std::int64_t capture_ns(std::int64_t n) const { return phase_ns + n * frame_ns; }

  void deliver(std::int64_t now_ns) {
    for (; running_ && capture_ns(next_) + delay_ns <= now_ns; ++next_, ++sequence_) {
      if (queued_.empty() || (loses && loses(next_))) continue;
      Buffer& buffer = buffers_[queued_.front()];
      const std::string content = bytes ? bytes(next_, format_.fourcc) : std::string();
      const std::size_t size = std::min(content.size(), buffer.memory.size());
      std::memcpy(buffer.memory.data(), content.data(), size);
      v4l2_buffer& out = buffer.filled;
      out.bytesused = static_cast<std::uint32_t>(size);
      out.sequence = static_cast<std::uint32_t>(sequence_);
      out.flags = (stamps_monotonic ? V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC : V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN) |
                  (stamps_at_end ? V4L2_BUF_FLAG_TSTAMP_SRC_EOF : V4L2_BUF_FLAG_TSTAMP_SRC_SOE) |
                  (damaged && damaged(next_) ? V4L2_BUF_FLAG_ERROR : 0);
      const std::int64_t stamp = capture_ns(next_) + (stamps_at_end ? frame_ns : 0) + (jitter_ns ? jitter_ns(next_) : 0);
      out.timestamp.tv_sec = stamp / 1'000'000'000;
      out.timestamp.tv_usec = stamp % 1'000'000'000 / 1000;
      filled_.push_back(queued_.front());
      queued_.pop_front();
    }
  }

  template <class T>
  static void put_text(T& field, const std::string& text) {
    std::memset(field, 0, sizeof field);
    std::memcpy(field, text.data(), std::min(text.size(), sizeof field - 1));
  }

  int answer(unsigned long request, void* argument, std::int64_t now_ns) {
    if (left()) return ENODEV;
    switch (request) {
      case VIDIOC_QUERYCAP: {
        auto& cap = *static_cast<v4l2_capability*>(argument);
        put_text(cap.card, name);
        put_text(cap.bus_info, bus);
        cap.capabilities = V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
        cap.device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
        return 0;
      }
      case VIDIOC_ENUM_FMT:
      case VIDIOC_ENUM_FRAMESIZES:
      case VIDIOC_ENUM_FRAMEINTERVALS:
        return enumerate(request, argument);
      case VIDIOC_S_FMT:
        return set_format(static_cast<v4l2_format*>(argument)->fmt.pix);
      case VIDIOC_S_PARM:
        static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {
            1000, static_cast<std::uint32_t>(1'000'000'000'000 / frame_ns)};
        return 0;
      case VIDIOC_REQBUFS:
        return make_buffers(*static_cast<v4l2_requestbuffers*>(argument));
      case VIDIOC_STREAMON:
        if (no_room >= 2 || (no_room == 1 && format_.fourcc != V4L2_PIX_FMT_MJPEG)) return ENOSPC;
        running_ = true;
        sequence_ = 0;
        next_ = std::max<std::int64_t>(0, (now_ns - phase_ns) / frame_ns + 1);
        return 0;
      case VIDIOC_STREAMOFF:
        running_ = false;
        queued_.clear();
        filled_.clear();
        return 0;
      default:
        return control(request, argument, now_ns);
    }
  }

  int enumerate(unsigned long request, void* argument) {
    std::vector<std::uint32_t> fourccs;
    for (const Mode& mode : modes)
      if (std::find(fourccs.begin(), fourccs.end(), mode.fourcc) == fourccs.end()) fourccs.push_back(mode.fourcc);
    const auto nth = [&](std::uint32_t index, auto&& fits) -> const Mode* {
      for (const Mode& mode : modes)
        if (fits(mode) && index-- == 0) return &mode;
      return nullptr;
    };
    if (request == VIDIOC_ENUM_FMT) {
      auto& format = *static_cast<v4l2_fmtdesc*>(argument);
      if (format.index >= fourccs.size()) return EINVAL;
      format.pixelformat = fourccs[format.index];
    } else if (request == VIDIOC_ENUM_FRAMESIZES) {
      auto& size = *static_cast<v4l2_frmsizeenum*>(argument);
      const Mode* mode = nth(size.index, [&](const Mode& m) { return m.fourcc == size.pixel_format; });
      if (mode == nullptr) return EINVAL;
      size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
      size.discrete = {mode->width, mode->height};
    } else {
      auto& rate = *static_cast<v4l2_frmivalenum*>(argument);
      const Mode* mode = nth(rate.index, [&](const Mode& m) {
        return m.fourcc == rate.pixel_format && m.width == rate.width && m.height == rate.height;
      });
      if (mode == nullptr) return EINVAL;
      rate.type = V4L2_FRMIVAL_TYPE_DISCRETE;
      rate.discrete = {1, mode->hz};
    }
    return 0;
  }

  int set_format(v4l2_pix_format& pix) {
    if (running_ || !buffers_.empty()) return EBUSY;
    format_ = forced.width != 0 ? forced : Mode{pix.pixelformat, pix.width, pix.height, 30};
    pix.pixelformat = format_.fourcc;
    pix.width = format_.width;
    pix.height = format_.height;
    pix.bytesperline = format_.fourcc == V4L2_PIX_FMT_MJPEG  ? 0
                       : format_.fourcc == V4L2_PIX_FMT_NV12 ? format_.width + kNv12Padding
                                                             : 2 * format_.width;
    pix.sizeimage = 2 * format_.width * format_.height;
    return 0;
  }

  int make_buffers(v4l2_requestbuffers& wanted) {
    buffers_.assign(wanted.count, {});
    for (Buffer& buffer : buffers_) buffer.memory.resize(std::size_t{2} * format_.width * format_.height);
    queued_.clear();
    filled_.clear();
    return 0;
  }

  int control(unsigned long request, void* argument, std::int64_t now_ns) {
    if (request == VIDIOC_QUERYBUF || request == VIDIOC_QBUF) {
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      if (buffer.index >= buffers_.size()) return EINVAL;
      buffer.length = static_cast<std::uint32_t>(buffers_[buffer.index].memory.size());
      buffer.m.offset = static_cast<std::uint32_t>(buffer.index * kBufferStep);
      if (request == VIDIOC_QBUF) queued_.push_back(buffer.index);
      return 0;
    }
    if (request == VIDIOC_DQBUF) {
      deliver(now_ns);
      if (filled_.empty()) return EAGAIN;
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      buffer = buffers_[filled_.front()].filled;
      buffer.index = filled_.front();
      filled_.pop_front();
      return 0;
    }
    const auto find = [&](std::uint32_t id) { return controls.find(id); };
    if (request == VIDIOC_QUERYCTRL) {
      auto& query = *static_cast<v4l2_queryctrl*>(argument);
      if (find(query.id) == controls.end()) return EINVAL;
      query = find(query.id)->second;
      return 0;
    }
    if (request == VIDIOC_G_CTRL || request == VIDIOC_S_CTRL) {
      auto& set = *static_cast<v4l2_control*>(argument);
      const auto at = find(set.id);
      if (at == controls.end()) return EINVAL;
      if (request == VIDIOC_S_CTRL && (set.value < at->second.minimum || set.value > at->second.maximum)) return ERANGE;
      (request == VIDIOC_S_CTRL ? at->second.default_value : set.value) =
          request == VIDIOC_S_CTRL ? set.value : at->second.default_value;
      return 0;
    }
    return ENOTTY;
  }

  std::mutex mutex_;
  Mode format_{};
  std::vector<Buffer> buffers_;
  std::deque<std::uint32_t> queued_, filled_;
  std::int64_t next_ = 0, sequence_ = 0;
  bool running_ = false, gone_ = false;
};

}  // namespace duo::test
