// Pictures into an AVI of JPEGs, as webcams give them.
#pragma once

#include <filesystem>
#include <string>

#include "core/file.h"
#include "core/libav.h"
#include "duoptic/image.h"
#include "duoptic/result.h"

namespace duo {

/// It takes its name in finish(). The same pictures give the same bytes.
class AviWriter {
 public:
  /// Errors  the file cannot be made
  static Result<AviWriter> open(const std::filesystem::path& path, Size size, int frames_per_second, int jpeg_quality);
  Result<void> write(View<const Rgb8> picture);
  Result<void> finish();

 private:
  AviWriter(PartialFile file, std::string name, int frames_per_second, int jpeg_quality)
      : file_(std::move(file)), name_(std::move(name)), rate_{frames_per_second, 1}, quality_(jpeg_quality) {}
  Error failed(int error) const;

  PartialFile file_;
  std::string name_;
  AVRational rate_;
  int quality_;
  std::int64_t count_ = 0;
  av::Muxer muxer_;
  av::Packet packet_;
};

}  // namespace duo
