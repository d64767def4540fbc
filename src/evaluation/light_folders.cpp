#include <fmt/format.h>

#include "core/file.h"
#include "duoptic/output_set.h"
#include "duoptic/sink.h"
#include "duoptic/structured_light.h"

namespace duo {
namespace {

Error stopped_before(const char* what) {
  return {ErrorCode::kBadInput, fmt::format("stopped before {}; nothing was written", what)};
}

Result<Picture> load_one(const std::filesystem::path& path) {
  DUO_TRY_ASSIGN(const auto source, open_source(path));
  Picture picture;
  DUO_TRY_ASSIGN(const Next next, source->next(picture));
  if (next == Next::kNew) return picture;
  return Error{ErrorCode::kBadInput, fmt::format("cannot use {}: it has no picture", path.string())};
}

Result<void> publish_with_code(const LightCode& code, OutputSet& out) {
  DUO_TRY(write_file(out / kLightCodeFile, json_from_light_code(code)));
  return out.publish();
}

}  // namespace

Result<void> write_light_patterns(const LightCode& code, int white, const std::filesystem::path& folder,
                                  const LightProgress& progress) {
  DUO_TRY(check_light_code(code));
  const auto patterns = light_patterns(code);
  DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(folder));
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    if (!progress(i)) return stopped_before("all patterns were drawn");
    DUO_TRY(write_png(draw_pattern(code, patterns[i], white), out / fmt::format("pattern_{:03}.png", i)));
  }
  return publish_with_code(code, out);
}

Result<void> record_light_folder(PairSource& pairs, const LightCode& code, const LightRecording& how, LightScreen& screen,
                                 const std::filesystem::path& folder, const LightProgress& progress) {
  DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(folder));
  DUO_TRY(record_light(pairs, code, how, screen, [&](std::size_t pattern, const Pair& pair) -> Result<void> {
    if (!progress(pattern + 1)) return stopped_before("all patterns were recorded");
    DUO_TRY(write_png(pair.left.pixels, out / light_file_name(true, pattern)));
    return write_png(pair.right.pixels, out / light_file_name(false, pattern));
  }));
  return publish_with_code(code, out);
}

Result<LightTruth> decode_light_folders(const LightCode& code, const LightFolders& what, const LightProgress& progress) {
  if (what.folders.empty()) return Error{ErrorCode::kBadInput, "cannot decode: name a folder of recorded pictures"};
  const bool other_light = !what.light.empty();
  if (other_light && what.light.size() != 2)
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot decode with {} picture{} in ordinary light: name two, left and right", what.light.size(),
                             what.light.size() == 1 ? "" : "s")};
  std::vector<LightFiles> files;
  for (const std::string& folder : what.folders) {
    DUO_TRY_ASSIGN(const auto found, find_light_files(folder, code));
    files.insert(files.end(), found.begin(), found.end());
  }
  std::optional<LightDecoder> decoder;
  Pair pair;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!progress(i)) return stopped_before("all pictures were decoded");
    DUO_TRY_ASSIGN(pair.left, load_one(files[i].left));
    DUO_TRY_ASSIGN(pair.right, load_one(files[i].right));
    if (!decoder) {
      DUO_TRY_ASSIGN(decoder, LightDecoder::open(code, what.rig, pair.left.pixels.size(), what.threads));
    }
    if (const auto added = decoder->add(pair); !added)
      return Error{added.error().code, fmt::format("{}: {}", files[i].left.parent_path().string(), added.error().what)};
  }
  if (other_light) {
    DUO_TRY_ASSIGN(pair.left, load_one(what.light[0]));
    DUO_TRY_ASSIGN(pair.right, load_one(what.light[1]));
  }
  return decoder->truth(other_light ? &pair : nullptr);
}

}  // namespace duo
