// Any bytes as a recording whose parts are written: one time for each pair, and videos that can be opened.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "core/check.h"
#include "core/libav.h"
#include "duoptic/recording.h"
#include "duoptic/source.h"
#include "sources/video.h"

int fuzz_export(const std::uint8_t* data, std::size_t size) {
  namespace fs = std::filesystem;
  static const int file = [] {
    av_log_set_level(AV_LOG_QUIET);
    return memfd_create("recording", 0);
  }();
  static const fs::path path = "/proc/self/fd/" + std::to_string(file);
  static const fs::path folder = [] {
    std::string name = (fs::exists("/dev/shm") ? "/dev/shm" : fs::temp_directory_path().string()) + "/duoptic_fuzz_XXXXXX";
    DUO_CHECK(mkdtemp(name.data()) != nullptr);
    std::atexit([] { fs::remove_all(folder); });
    return name;
  }();
  DUO_CHECK(ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
  const duo::RecordingFiles to{folder / "left.avi", folder / "right.avi", folder / "times.csv"};
  for (const fs::path& one : {to.left_avi, to.right_avi, to.times_csv}) fs::remove(one);
  const auto report = duo::inspect_recording(path);
  if (!duo::export_recording(path, to)) return 0;
  std::ifstream times(to.times_csv);
  const auto lines = std::count(std::istreambuf_iterator<char>(times), {}, '\n');
  DUO_CHECK(fs::exists(to.left_avi) && fs::exists(to.right_avi) && lines >= 1);
  if (report) DUO_CHECK(lines - 1 >= report->pairs);
  return 0;
}
