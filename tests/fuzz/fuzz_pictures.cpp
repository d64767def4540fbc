// Any bytes as a picture file: what is accepted has pixels, no more than may be.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "core/check.h"
#include "core/libav.h"
#include "sources/pictures.h"

int fuzz_pictures(const std::uint8_t* data, std::size_t size) {
  constexpr std::int64_t kMost = 1 << 20;
  static const int file = [] {
    av_log_set_level(AV_LOG_QUIET);
    duo::limit_pictures(kMost);
    return memfd_create("picture", 0);
  }();
  static const std::filesystem::path path = "/proc/self/fd/" + std::to_string(file);
  DUO_CHECK(ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
  if (const auto source = duo::open_picture(path)) {
    duo::Picture picture;
    DUO_CHECK((*source)->next(picture) && picture.pixels.size() == (*source)->size() && !picture.pixels.empty());
    DUO_CHECK(std::int64_t{picture.pixels.width()} * picture.pixels.height() <= kMost);
  }
  if (const auto gray = duo::read_png16(path)) DUO_CHECK(!gray->empty());
  return 0;
}
