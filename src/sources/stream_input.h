// Where the pictures of a stream come from: an address that libav opens, or a GStreamer pipeline in a process of its own, which
// can be ended when it hangs.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "duoptic/source.h"
#include "sources/libav.h"

namespace duo {

constexpr char kGstPrefix[] = "gst:";

/// A GStreamer pipeline run by gst-launch-1.0, whose raw pictures come through a pipe as YUV4MPEG2.
class GstProcess {
 public:
  GstProcess() = default;
  GstProcess(const GstProcess&) = delete;
  GstProcess& operator=(const GstProcess&) = delete;
  ~GstProcess() { end(); }

  /// Starts it; `pipeline` as for gst-launch-1.0, with or without an appsink at its end.
  ///
  /// Returns  "" or why it does not run
  std::string start(const std::string& pipeline);
  /// Kills it: who reads its pictures sees their end.
  void end();
  /// What it said last of why it stopped; "" for nothing.
  std::string complaint() const;
  int pictures_fd() const { return pictures_; }

 private:
  int process_ = -1, pictures_ = -1, words_ = -1;
};

/// The words of a pipeline as a shell would split them: at spaces that are not in quotes.
std::vector<std::string> words_of(const std::string& pipeline);

/// One connection. Nothing in it waits longer than it should: time, or who no longer wants it, ends every call into libav.
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
