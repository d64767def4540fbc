// Pictures into a video file, through libav.
#pragma once

#include <filesystem>
#include <string>

#include "core/file.h"
#include "core/libav.h"
#include "duoptic/image.h"
#include "duoptic/result.h"

namespace duo {

/// An MP4 that takes its name in finish(): H.264 where libav can write it, else MPEG-4 part 2; 4:2:0, BT.709. The same
/// pictures give the same bytes.
class VideoWriter {
 public:
  /// Shape   pictures of `size`, even in both directions
  /// Errors  no encoder; those of every written file
  static Result<VideoWriter> open(const std::filesystem::path& path, Size size, double frame_s);
  Result<void> write(View<const Rgb8> picture);
  Result<void> finish();
  bool is_h264() const { return encoder_->codec_id == AV_CODEC_ID_H264; }

 private:
  VideoWriter(PartialFile file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}
  Result<void> prepare(Size size, double frame_s);
  Result<void> encode(const AVFrame* frame);
  Error failed(int error) const;

  PartialFile file_;
  std::string name_;
  av::Muxer muxer_;
  av::Coder encoder_;
  av::Scaler scaler_;
  av::CodedFrame frame_;
  av::Packet packet_;
};

}  // namespace duo
