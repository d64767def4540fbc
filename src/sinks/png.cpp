#include <fmt/format.h>

#include "core/coded_picture.h"
#include "core/file.h"
#include "duoptic/sink.h"

namespace duo {
namespace {

template <class T>
Result<void> write(View<const T> picture, const std::filesystem::path& path) {
  const std::string bytes = png_of(picture);
  if (!bytes.empty()) return write_file(path, bytes);
  return Error{ErrorCode::kWriteFailed,
               fmt::format("cannot write '{}': {}x{} pixels cannot be encoded as PNG; give a picture of at least one pixel",
                           shown(path).string(), picture.width(), picture.height())};
}

}  // namespace

Result<void> write_png(View<const Rgb8> picture, const std::filesystem::path& path) { return write(picture, path); }
Result<void> write_png(View<const std::uint8_t> picture, const std::filesystem::path& path) { return write(picture, path); }
Result<void> write_png(View<const std::uint16_t> picture, const std::filesystem::path& path) { return write(picture, path); }

}  // namespace duo
