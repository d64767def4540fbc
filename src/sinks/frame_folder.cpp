#include <fmt/format.h>

#include <utility>

#include "duoptic/frame_files.h"
#include "duoptic/output_set.h"

namespace duo {

namespace fs = std::filesystem;

struct FrameFolder::State {
  fs::path folder;
  FrameFiles files;
  std::optional<Rectified> rectified;
  bool still = false, each = false, in_one = false;
  double frame_s = 0;
  std::vector<std::string> paths = {};
  std::shared_ptr<const Frame> last = {};
  std::optional<OutputSet> out = {};     // of the video
  std::optional<DepthVideo> video = {};  // after the folder that it is written into

  void keep_paths(const OutputSet& of) {
    for (std::string& path : of.paths()) paths.push_back(std::move(path));
  }
};

FrameFolder::FrameFolder(std::unique_ptr<State> state) : state_(std::move(state)) {}
FrameFolder::FrameFolder(FrameFolder&&) noexcept = default;
FrameFolder::~FrameFolder() = default;

Result<FrameFolder> FrameFolder::open(fs::path folder, FrameFiles files, bool asked, const std::optional<Rectified>& rectified,
                                      bool still, double frame_s) {
  for (const FrameOutput output : files.outputs) {
    const std::string_view name = kFrameOutputNames[static_cast<std::size_t>(output)];
    const bool any_pair = output == FrameOutput::kDisparity || output == FrameOutput::kConfidence;
    if (asked && !any_pair && !rectified)
      return Error{ErrorCode::kBadInput, fmt::format("cannot write {}: it needs a rig; give one with --rig", name)};
    if (output == FrameOutput::kDepthVideo && still)
      return Error{ErrorCode::kBadInput, fmt::format("cannot write {} of one picture; take --outputs depth", name)};
  }
  const bool in_one = files.has(FrameOutput::kDepthVideo), each = files.outputs.size() > (in_one ? 1 : 0);
  return FrameFolder(
      std::unique_ptr<State>(new State{std::move(folder), std::move(files), rectified, still, each, in_one, frame_s}));
}

void FrameFolder::set_disparity_sigma_px(double sigma_px) { state_->files.disparity_sigma_px = sigma_px; }
const std::vector<std::string>& FrameFolder::paths() const { return state_->paths; }

Result<void> FrameFolder::write(const std::shared_ptr<const Frame>& frame, std::uint64_t number, double t_s) {
  State& s = *state_;
  if (s.each) {
    DUO_TRY_ASSIGN(OutputSet out, OutputSet::open(s.still ? s.folder : s.folder / fmt::format("frame_{:06}", number)));
    DUO_TRY(write_frame(*frame, s.rectified, s.files, [&](const std::string& name) { return out / name; }));
    DUO_TRY(out.publish(frame_file_names()));
    s.keep_paths(out);
  }
  if (!s.in_one) return {};
  s.last = frame;
  if (!s.video) {
    auto out = OutputSet::open(s.folder);
    if (!out) return out.error();
    s.out.emplace(std::move(*out));
    DUO_TRY_ASSIGN(s.video, DepthVideo::open(*s.out / "depth.mkv", frame->depth_mm.size(), s.frame_s));
  }
  return s.video->write(near_depth(frame->depth_mm, s.files.cloud.far_m), t_s);
}

Result<void> FrameFolder::finish() {
  State& s = *state_;
  if (!s.video) return {};
  DUO_TRY(s.video->finish());
  FrameFiles camera = s.files;
  camera.outputs = {FrameOutput::kCamera};
  DUO_TRY(write_frame(*s.last, s.rectified, camera, [&](const std::string& name) { return *s.out / name; }));
  DUO_TRY(s.out->publish());
  s.keep_paths(*s.out);
  return {};
}

}  // namespace duo
