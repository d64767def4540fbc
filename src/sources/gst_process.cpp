#include "sources/gst_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace duo {

std::vector<std::string> words_of(const std::string& pipeline) {
  std::vector<std::string> words;
  bool inside = false;  // of a word
  char quote = 0;
  for (const char c : pipeline) {
    if (quote == 0 && (c == ' ' || c == '\t' || c == '\n')) {
      inside = false;
      continue;
    }
    if (!inside) words.emplace_back();
    inside = true;
    if (quote == 0 && (c == '"' || c == '\''))
      quote = c;
    else if (c == quote)
      quote = 0;
    else
      words.back() += c;
  }
  return words;
}

std::string GstProcess::start(const std::string& pipeline) {
  std::vector<std::string> words = words_of(pipeline);
  // Other programs' pipelines end in the sink that they read: its place is ours.
  for (std::size_t i = words.size(); i-- > 0;)
    if (words[i] == "!") {
      if (i + 1 < words.size() && words[i + 1] == "appsink") words.resize(i);
      break;
    }
  if (words.empty()) return "it is empty";
  words.insert(words.begin(), {"gst-launch-1.0", "-q"});
  // 4:4:4 keeps every colour; the range and matrix are what YUV4MPEG2 means when it says nothing.
  for (const char* word :
       {"!", "videoconvert", "!", "video/x-raw,format=Y444,colorimetry=bt601", "!", "y4menc", "!", "fdsink", "fd=1"})
    words.emplace_back(word);

  int pipe[2];
  if (pipe2(pipe, O_CLOEXEC) != 0) return std::strerror(errno);
  pictures_ = pipe[0];
  fcntl(pictures_, F_SETFL, O_NONBLOCK);  // libav then asks between its reads whether to go on
  constexpr int kRoom = 1 << 20;
  fcntl(pictures_, F_SETPIPE_SZ, kRoom);
  words_ = memfd_create("gst", MFD_CLOEXEC);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, pipe[1], 1);
  if (words_ >= 0) posix_spawn_file_actions_adddup2(&files, words_, 2);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // Ctrl-C is ours: we end it
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int failed = posix_spawnp(&process_, argv[0], &files, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  close(pipe[1]);
  if (failed == 0) return {};
  process_ = -1;
  return failed == ENOENT ? "gst-launch-1.0 is not there; install gstreamer1.0-tools and gstreamer1.0-plugins-good"
                          : fmt::format("gst-launch-1.0 does not start: {}", std::strerror(failed));
}

void GstProcess::end() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  if (pictures_ >= 0) close(pictures_);
  if (words_ >= 0) close(words_);
  process_ = pictures_ = words_ = -1;
}

std::string GstProcess::complaint() const {
  char text[4096];
  const ssize_t size = words_ < 0 ? 0 : pread(words_, text, sizeof text, 0);
  std::string_view rest(text, size > 0 ? static_cast<std::size_t>(size) : 0);
  // Its first line that names a fault: "ERROR: from element /...: why", "WARNING: erroneous pipeline: why".
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    for (const std::string_view start : {"ERROR: ", "WARNING: "})
      if (line.starts_with(start)) return std::string(line.substr(start.size()));
  }
  return {};
}

}  // namespace duo
