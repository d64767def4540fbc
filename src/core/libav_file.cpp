#include "core/libav_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <memory>

namespace duo::av {
namespace {

/// The place of one reader or writer in a file: several do not move each other.
struct FilePlace {
  int fd;
  std::int64_t at = 0;

  static int read(void* self, std::uint8_t* bytes, int size) {
    auto& place = *static_cast<FilePlace*>(self);
    const ssize_t n = ::pread(place.fd, bytes, static_cast<std::size_t>(size), place.at);
    if (n < 0) return AVERROR(errno);
    place.at += n;
    return n == 0 ? AVERROR_EOF : static_cast<int>(n);
  }
  static int write(void* self, std::uint8_t* bytes, int size) {
    auto& place = *static_cast<FilePlace*>(self);
    for (int done = 0; done < size;) {
      const ssize_t n = ::pwrite(place.fd, bytes + done, static_cast<std::size_t>(size - done), place.at);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return AVERROR(errno);
      place.at += n;
      done += static_cast<int>(n);
    }
    return size;
  }
  static std::int64_t seek(void* self, std::int64_t offset, int whence) {
    auto& place = *static_cast<FilePlace*>(self);
    struct stat now {};
    if (::fstat(place.fd, &now) != 0) return AVERROR(errno);
    if ((whence & AVSEEK_SIZE) != 0) return now.st_size;
    const std::int64_t from = whence == SEEK_CUR ? place.at : whence == SEEK_END ? now.st_size : 0;
    if (from + offset < 0) return AVERROR(EINVAL);
    return place.at = from + offset;
  }
};

/// nullptr: out of memory.
AVIOContext* open_place(int fd, bool writes) {
  constexpr int kBuffer = 1 << 15;
  auto place = std::make_unique<FilePlace>(FilePlace{fd});
  auto* buffer = static_cast<unsigned char*>(av_malloc(kBuffer));
  AVIOContext* io = buffer == nullptr
                        ? nullptr
                        : avio_alloc_context(buffer, kBuffer, writes ? 1 : 0, place.get(), writes ? nullptr : FilePlace::read,
                                             writes ? FilePlace::write : nullptr, FilePlace::seek);
  if (io == nullptr) return av_free(buffer), nullptr;
  place.release();
  return io;
}

int open_again(AVFormatContext* muxer, AVIOContext** io, const char*, int flags, AVDictionary**) {
  if ((flags & AVIO_FLAG_WRITE) != 0) return AVERROR(EPERM);
  *io = open_place(static_cast<FilePlace*>(muxer->pb->opaque)->fd, false);
  return *io == nullptr ? AVERROR(ENOMEM) : 0;
}

int close_again(AVFormatContext*, AVIOContext* io) {
  close_file(io);
  return 0;
}

}  // namespace

void close_file(AVIOContext* io) {
  if (io == nullptr) return;
  delete static_cast<FilePlace*>(io->opaque);
  av_free(io->buffer);
  avio_context_free(&io);
}

int write_into(AVFormatContext& muxer, int fd) {
  muxer.pb = open_place(fd, true);
  muxer.io_open = open_again;
  muxer.io_close2 = close_again;
  return muxer.pb == nullptr ? AVERROR(ENOMEM) : 0;
}

int flush(AVFormatContext& muxer) {
  avio_flush(muxer.pb);
  return muxer.pb->error;
}

}  // namespace duo::av
