// One camera's pictures as packets for a recording.
#pragma once

#include <string>

#include "core/libav.h"
#include "duoptic/frame.h"
#include "duoptic/result.h"

namespace duo {

/// JPEG as it was delivered when the first picture has one, else FFV1 of its RGB, without loss; each packet stands alone.
class CodedView {
 public:
  /// Errors  libav lacks FFV1
  static Result<CodedView> open(const Picture& first);

  /// What a container must know of the packets.
  bool describe(AVCodecParameters& parameters) const;
  std::string codec() const { return encoder_ ? "FFV1" : "MJPEG"; }
  /// The packet of a picture, without times; nullptr when it is of another size, or no longer JPEG.
  av::Packet code(const Picture& picture);

 private:
  Size size_;
  av::Coder encoder_;     // empty: JPEG as it comes
  av::CodedFrame frame_;  // what the encoder reads
};

}  // namespace duo
