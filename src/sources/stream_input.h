// Where the pictures of a stream come from: an address that libav opens, or a GStreamer pipeline in a process of its own, which
// can be ended when it hangs.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "duoptic/source.h"
#include "sources/gst_process.h"
#include "sources/libav.h"

namespace duo {

constexpr char kGstPrefix[] = "gst:";

/// One connection. A timeout, or a request to stop, ends every call into libav.
class StreamInput {
 public:
  explicit StreamInput(std::function<bool()> unwanted) : unwanted_(std::move(unwanted)) {}

  /// Returns  "" or why there are no pictures
  std::string open(const std::string& name);
  /// Decodes the next whole picture into `into`: its pixels, and its JPEG where it came as one.
  ///
  /// Returns  false when the stream has broken off
  bool next(Picture& into);
  double rate_hz() const { return rate_hz_; }  // 0: not known

 private:
  static int is_over(void* self);
  std::string connect(const std::string& name);
  std::string open_container(const char* url, const AVInputFormat* format);
  void allow(std::chrono::nanoseconds time) { until_ = std::chrono::steady_clock::now() + time; }

  std::function<bool()> unwanted_;
  std::chrono::steady_clock::time_point until_;
  GstProcess gst_;
  av::Container container_;
  av::Decoder decoder_;
  av::DecodedFrame frame_{av_frame_alloc()};
  av::Packet packet_{av_packet_alloc()};
  av::ToRgb to_rgb_;
  int stream_ = -1;
  double rate_hz_ = 0;
};

}  // namespace duo
