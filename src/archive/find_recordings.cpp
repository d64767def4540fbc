// Which videos of a folder belong together, and with which rig.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "archive/layout.h"
#include "core/json_text.h"
#include "duoptic/archive.h"
#include "duoptic/source.h"
#include "sources/recording.h"

namespace duo {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kVideoEndings[] = {".avi",  ".mkv", ".mp4",  ".mov", ".m4v",
                                              ".webm", ".mpg", ".mpeg", ".ts",  ".mjpeg"};
constexpr std::string_view kRigNames[] = {"rig.json",         "rig.yml",          "rig.yaml",
                                          "rig.xml",          "calibration.json", "calibration.yml",
                                          "calibration.yaml", "calibration.xml",  "calibration_truth.yml",
                                          "camchain.yaml"};

std::string lowercase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// `text` with its last word `word` replaced, in the word's own case; empty where it has none. Words are letters between
/// others.
std::string with_word(const std::string& text, std::string_view word, std::string_view other) {
  const std::string small = lowercase(text);
  for (std::size_t at = small.rfind(word); at != std::string::npos;
       at = at == 0 ? std::string::npos : small.rfind(word, at - 1)) {
    const std::size_t end = at + word.size();
    if ((at > 0 && is_letter(text[at - 1])) || (end < text.size() && is_letter(text[end]))) continue;
    std::string replaced(other);
    const bool first_large = std::isupper(static_cast<unsigned char>(text[at])) != 0;
    const bool all_large = first_large && std::isupper(static_cast<unsigned char>(text[end - 1])) != 0;
    for (std::size_t i = 0; i < replaced.size() && first_large; ++i)
      if (i == 0 || all_large) replaced[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(replaced[i])));
    return text.substr(0, at) + replaced + text.substr(end);
  }
  return {};
}

struct Side {
  const char *left, *right;
};
constexpr Side kSides[] = {{"left", "right"}, {"l", "r"}};

/// The other path of a pair whose path (relative) says that it is the one side; empty where it does not, or `files` lack it.
fs::path partner(const fs::path& path, bool is_left, const std::set<fs::path>& files, fs::path& without_side) {
  for (const Side& side : kSides) {
    const char *own = is_left ? side.left : side.right, *other = is_left ? side.right : side.left;
    const std::string stem = path.stem(), ending = path.extension();
    if (const std::string name = with_word(stem, own, other); !name.empty()) {
      const fs::path found = path.parent_path() / (name + ending);
      if (!files.contains(found)) continue;
      std::string rest = with_word(stem, own, "");
      while (!rest.empty() && std::ispunct(static_cast<unsigned char>(rest.back())) != 0) rest.pop_back();
      while (!rest.empty() && std::ispunct(static_cast<unsigned char>(rest.front())) != 0) rest.erase(0, 1);
      without_side = path.parent_path() / rest;
      if (rest.empty()) without_side = path.parent_path().empty() ? fs::path("recording") : path.parent_path();
      return found;
    }
    const fs::path folder = path.parent_path();
    if (const std::string name = with_word(folder.filename(), own, other); !name.empty()) {
      const fs::path found = folder.parent_path() / name / path.filename();
      if (!files.contains(found)) continue;
      without_side = folder.parent_path() / stem;
      return found;
    }
  }
  return {};
}

/// The nearest rig file of a recording, in its folder or one above it up to the archive.
fs::path rig_of(const fs::path& archive, const fs::path& id, const fs::path& first_input, std::map<fs::path, fs::path>& known) {
  const fs::path beside = archive / first_input.parent_path();
  for (const std::string ending : {"_rig.json", ".rig.json", "_rig.yml", ".rig.yml"})
    if (const fs::path own = beside / (id.filename().string() + ending); is_file(own)) return own;
  const auto in = [&](const fs::path& folder) {
    const auto [at, is_new] = known.try_emplace(folder);
    for (std::size_t i = 0; is_new && i < std::size(kRigNames) && at->second.empty(); ++i)
      if (is_file(archive / folder / kRigNames[i])) at->second = archive / folder / kRigNames[i];
    return at->second;
  };
  for (fs::path folder = first_input.parent_path();; folder = folder.parent_path()) {
    if (const fs::path found = in(folder); !found.empty()) return found;
    if (folder.empty()) return {};
  }
}

Result<std::set<fs::path>> videos_in(const fs::path& archive) {
  std::set<fs::path> out;
  std::error_code error;
  fs::recursive_directory_iterator at(archive, error);
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    const fs::path& path = at->path();
    if (path.filename().native().starts_with(".")) {
      if (at->is_directory(error)) at.disable_recursion_pending();
      continue;
    }
    const std::string ending = lowercase(path.extension());
    const bool video = std::find(std::begin(kVideoEndings), std::end(kVideoEndings), ending) != std::end(kVideoEndings);
    if (video && at->is_regular_file(error)) out.insert(path.lexically_relative(archive));
    if (fs::exists(path / "manifest.jsonl", error)) at.disable_recursion_pending();  // the results of a batch
    error.clear();
  }
  if (error) return Error{ErrorCode::kNotFound, fmt::format("cannot read archive '{}': {}", archive.string(), error.message())};
  if (out.empty())
    return Error{ErrorCode::kNotFound, fmt::format("cannot plan '{}': there is no video in it ({})", archive.string(),
                                                   fmt::join(kVideoEndings, " "))};
  return out;
}

/// One side of a pair whose other side is missing.
bool says_a_side(const fs::path& path) {
  const std::string stem = path.stem(), folder = path.parent_path().filename();
  return !with_word(stem, "left", "right").empty() || !with_word(stem, "right", "left").empty() ||
         !with_word(folder, "left", "right").empty() || !with_word(folder, "right", "left").empty();
}

constexpr std::int64_t kPixelsPerShard = std::int64_t{2000} * 640 * 480;  // some 45 s at 21 ms for 640x480

/// The task as ranges of frames; as it is where its frames are not known or few.
std::vector<ArchiveTask> shards_of(const ArchiveTask& task, std::int64_t shard_frames) {
  const auto pairs = open_pairs(task.inputs[0], task.inputs.size() > 1 ? task.inputs[1] : "");
  const std::int64_t count = pairs ? (*pairs)->count() : 0;  // what cannot be opened fails with the tool's own words
  if (shard_frames <= 0 && count > 0) {
    const Size size = (*pairs)->size();
    shard_frames = std::max<std::int64_t>(1, kPixelsPerShard / (std::int64_t{size.width} * size.height));
  }
  if (count <= shard_frames) return {task};
  const std::int64_t shards = std::max<std::int64_t>(1, (count + shard_frames / 2) / shard_frames);  // the last is no rest
  std::vector<ArchiveTask> out(static_cast<std::size_t>(shards), task);
  for (std::int64_t i = 0; i < shards; ++i) {
    out[static_cast<std::size_t>(i)].begin = i * shard_frames;
    out[static_cast<std::size_t>(i)].end = i + 1 < shards ? (i + 1) * shard_frames : 0;
  }
  return out;
}

/// What makes results the same files on all machines, where the wish does not say otherwise.
std::vector<std::string> arguments_of(const ArchiveWish& wish) {
  std::vector<std::string> words = wish.arguments;
  const auto has = [&](std::string_view option) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return word == option || word.starts_with(std::string(option) + "="); });
  };
  if (!has("--engine")) words.insert(words.end(), {"--engine", "simd"});
  if (wish.command == "depth" && !has("--outputs")) words.insert(words.end(), {"--outputs", "depth-video"});
  return words;
}

/// A manifest can name nothing else.
bool is_utf8(const std::string& text) {
  return nlohmann::json::parse(json_text(nlohmann::json(text), -1)).get<std::string>() == text;
}

}  // namespace

Result<ArchivePlan> plan_archive(const fs::path& given, const ArchiveWish& wish) {
  std::error_code error;
  const fs::path archive = fs::canonical(given, error);
  if (error || !fs::is_directory(archive, error))
    return Error{ErrorCode::kNotFound,
                 fmt::format("cannot read archive '{}': {}", given.string(), error ? error.message() : "it is no folder")};
  if (!is_utf8(archive) || !is_utf8(wish.rig))
    return Error{ErrorCode::kBadInput, fmt::format("cannot plan '{}': a name with bytes that are no UTF-8 cannot be in a manifest; "
                                                   "rename it",
                                                   is_utf8(archive) ? wish.rig : archive.string())};
  DUO_TRY_ASSIGN(const std::set<fs::path> videos, videos_in(archive));
  const std::vector<std::string> arguments = arguments_of(wish);
  ArchivePlan plan;
  std::map<fs::path, fs::path> known_rigs;
  std::map<std::string, int> ids;
  for (const fs::path& video : videos) {
    fs::path id = video.parent_path() / video.stem();
    ArchiveTask task{.id = {}, .inputs = {archive / video}, .command = wish.command, .arguments = arguments};
    if (const fs::path right = partner(video, true, videos, id); !right.empty())
      task.inputs.push_back(archive / right);
    else if (fs::path unused; !partner(video, false, videos, unused).empty())
      continue;  // the right one of a pair
    else if (says_a_side(video)) {
      plan.left_out.push_back(fmt::format("{}: its name says that it is one side, and the other is not there", video.string()));
      continue;
    }
    task.rig = wish.rig.empty() ? rig_of(archive, id, video, known_rigs).string() : wish.rig;
    if (!std::all_of(task.inputs.begin(), task.inputs.end(), is_utf8) || !is_utf8(task.rig)) {
      plan.left_out.push_back(
          fmt::format("{}: a name with bytes that are no UTF-8 cannot be in a manifest; rename it", video.string()));
      continue;
    }
    task.id = id;
    if (ids[task.id]++ > 0) task.id += video.extension().string();
    if (wish.rig.empty() && task.inputs.size() == 1 && lowercase(video.extension()) == ".mkv")
      if (const auto tracks = open_two_tracks(archive / video); tracks && tracks->container)
        if (const auto own = tracks->rig(video); own && *own) task.rig.clear();
    if (wish.command != "depth") {
      plan.tasks.push_back(std::move(task));
      continue;
    }
    for (ArchiveTask& shard : shards_of(task, wish.shard_frames)) plan.tasks.push_back(std::move(shard));
  }
  std::stable_sort(plan.tasks.begin(), plan.tasks.end(),
                   [](const ArchiveTask& a, const ArchiveTask& b) { return a.id < b.id; });
  return plan;
}

}  // namespace duo
