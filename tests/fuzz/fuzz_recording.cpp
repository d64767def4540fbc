// Any bytes as a recording: its head, its report and its pictures. libav is Debian's, not instrumented; what lies around it is.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "core/check.h"
#include "duoptic/recording.h"
#include "duoptic/source.h"
#include "sources/recording.h"
#include "sources/video.h"
#include "tests/fuzz/accepted_rig.h"

namespace duo {

namespace {

/// To its end, or as far as time allows; each picture is a whole one.
void read_view(const std::filesystem::path& path, int track) {
  constexpr int kMost = 50;
  const auto view = open_video(path, track);
  if (!view) return;
  DUO_CHECK(!(*view)->size().empty() && (*view)->frame_s() > 0 && (*view)->count() >= 0);
  Picture picture;
  for (int i = 0; i < kMost; ++i) {
    const auto next = (*view)->next(picture);
    if (!next || *next != Next::kNew) return;
    DUO_CHECK(picture.pixels.size() == (*view)->size());
  }
}

}  // namespace
}  // namespace duo

int fuzz_recording(const std::uint8_t* data, std::size_t size) {
  av_log_set_level(AV_LOG_QUIET);
  static const int file = memfd_create("recording", 0);
  static const std::filesystem::path path = "/proc/self/fd/" + std::to_string(file);
  DUO_CHECK(ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
  const auto head = duo::read_recording_head(path);
  if (head && *head && (*head)->rig) duo::fuzz::check_accepted(*(*head)->rig);
  if (const auto report = duo::inspect_recording(path)) {
    DUO_CHECK(report->pairs >= 0 && report->pairs <= report->left.pictures && report->pairs <= report->right.pictures);
    DUO_CHECK(report->left.missing >= 0 && report->right.missing >= 0 && report->skew_s >= 0);
  }
  for (const int track : {0, 1}) duo::read_view(path, track);
  return 0;
}
