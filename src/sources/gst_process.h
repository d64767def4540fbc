// A GStreamer pipeline in a process of its own, which can be ended when it hangs.
#pragma once

#include <string>
#include <vector>

namespace duo {

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
  /// Kills the process: a reader of its pictures sees the end of the stream.
  void end();
  /// Its last error message; "" for none.
  std::string complaint() const;
  int pictures_fd() const { return pictures_; }

 private:
  int process_ = -1, pictures_ = -1, words_ = -1;
};

/// The words of a pipeline as a shell would split them: at spaces that are not in quotes.
std::vector<std::string> words_of(const std::string& pipeline);

}  // namespace duo
