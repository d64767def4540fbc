// Where the pictures of a stream come from: an address, or a GStreamer pipeline in a process of its own, which can be ended
// when it hangs.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "duoptic/source.h"
#include "sources/gst_process.h"
#include "sources/http_bytes.h"
#include "sources/libav.h"

namespace duo {

constexpr char kGstPrefix[] = "gst:";

/// One connection. Nothing in it waits longer than it should: time, or who no longer wants it, ends every call into libav; and
/// it reaches nothing but what was named. libav gets the bytes of an http address or a pipeline from us, and may open nothing;
/// of an rtsp address it may open one connection.
class StreamInput {
 public:
  explicit StreamInput(std::function<bool()> unwanted) : unwanted_(std::move(unwanted)) {}

  /// Returns  "" or why there are no pictures
  std::string open(const std::string& name);
  /// Decodes the next whole picture into `into`: its pixels, and its JPEG where it came as one.
  ///
  /// Returns  false when the stream has broken off
  bool next(Picture& into);
  double frame_s() const { return frame_s_; }  // from picture to picture, where the stream says it; else 0

  /// Gives up to `size` bytes: how many, 0 at the end, or an error number of libav's.
  using Read = std::function<int(std::uint8_t* into, int size)>;
  /// As open(), of bytes that come otherwise: as a pipeline writes them, or a web server that calls them `kind`.
  std::string open_pipeline(Read read);
  std::string open_web(Read read, const std::string& kind);

 private:
  bool is_over() const { return unwanted_() || std::chrono::steady_clock::now() > until_; }
  static int is_over(void* self);
  static int read(void* self, std::uint8_t* into, int size);
  int read_pipe(std::uint8_t* into, int size);
  std::string connect(const std::string& name);
  std::string open_bytes(Read read, std::int64_t most, const char* formats, const char* format);
  std::string open_container(const char* url, const char* formats, const char* format);
  std::string open_decoder();
  void allow(std::chrono::nanoseconds time);

  struct FreeBytes {
    void operator()(AVIOContext* p) const {
      av_free(p->buffer);
      avio_context_free(&p);
    }
  };

  std::function<bool()> unwanted_;
  std::chrono::steady_clock::time_point until_ = std::chrono::steady_clock::time_point::max();
  Read read_;
  std::int64_t most_bytes_ = 0, bytes_left_ = 0;  // that may come before the next picture
  GstProcess gst_;
  HttpBytes http_{[this] { return is_over(); }};
  std::unique_ptr<AVIOContext, FreeBytes> bytes_;  // of read_
  av::Container container_;
  av::Decoder decoder_;
  av::DecodedFrame frame_{av_frame_alloc()};
  av::Packet packet_{av_packet_alloc()};
  av::ToRgb to_rgb_;
  AVFormatContext* opening_ = nullptr;  // what may still connect, once
  int stream_ = -1;
  double frame_s_ = 0;
};

}  // namespace duo
