// glTF 2.0, binary: a JSON chunk and a chunk of numbers.
#include <array>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/file.h"
#include "core/json_text.h"
#include "duoptic/sink.h"
#include "sinks/motion_tracks.h"

namespace duo {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF's numbers are written as the machine holds them");

/// The chunk of numbers, and the accessors that say where which of them lie.
class GltfNumbers {
 public:
  /// Shape  values: `width` per element, 1, 3 or 4. `bounded`: least and greatest are told, as times need.
  std::size_t add(const std::vector<float>& values, int width, bool bounded = false) {
    constexpr int kFloat = 5126;
    const std::size_t bytes = values.size() * sizeof(float);
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes}});
    bytes_.append(reinterpret_cast<const char*>(values.data()), bytes);
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", kFloat},
                          {"count", values.size() / static_cast<std::size_t>(width)},
                          {"type", width == 1   ? "SCALAR"
                                   : width == 3 ? "VEC3"
                                                : "VEC4"}});
    if (bounded) {
      accessors_.back()["min"] = {values.front()};
      accessors_.back()["max"] = {values.back()};
    }
    return accessors_.size() - 1;
  }
  const std::string& bytes() const { return bytes_; }
  void put_into(nlohmann::ordered_json& gltf) const {
    gltf["accessors"] = accessors_;
    gltf["bufferViews"] = views_;
    gltf["buffers"] = {{{"byteLength", bytes_.size()}}};
  }

 private:
  std::string bytes_;
  std::vector<nlohmann::ordered_json> views_, accessors_;
};

std::array<float, 3> floats_of(Vec3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

/// Nodes of all persons, and one animation of them.
class GltfScene {
 public:
  GltfScene(std::size_t count, double frame_s) : count_(count) {
    std::vector<float> times_s;
    for (std::size_t i = 0; i < count; ++i) times_s.push_back(static_cast<float>(static_cast<double>(i) * frame_s));
    times_ = numbers_.add(times_s, 1, true);
  }

  void add(const MotionTrack& track) {
    const std::size_t first = nodes_.size(), joints = track.skeleton().joints.size();
    const auto poses = track.poses(count_);
    nlohmann::ordered_json in_skin = nlohmann::ordered_json::array();
    for (std::size_t j = 0; j < joints; ++j) {
      nlohmann::ordered_json node = {{"name", track.joint_name(j)}};
      if (j > 0) node["translation"] = floats_of(track.offset_m(j));
      for (const std::size_t child : track.children(j)) node["children"].push_back(first + child);
      nodes_.push_back(std::move(node));
      in_skin.push_back(first + j);
      if (!track.children(j).empty()) animate(first + j, "rotation", rotations(poses, j), 4);
    }
    std::vector<float> places;
    for (const MotionTrack::Pose& pose : poses)
      for (const float value : floats_of(pose.root_m)) places.push_back(value);
    animate(first, "translation", places, 3);
    roots_.push_back(first);
    skins_.push_back({{"joints", std::move(in_skin)}, {"skeleton", first}});
  }

  /// The whole file.
  std::string bytes() const {
    nlohmann::ordered_json gltf = {{"asset", {{"version", "2.0"}, {"generator", "Duoptic"}}},
                                   {"scene", 0},
                                   {"scenes", {{{"nodes", roots_}}}},
                                   {"nodes", nodes_},
                                   {"skins", skins_},
                                   {"animations", {{{"name", "people"}, {"channels", channels_}, {"samplers", samplers_}}}}};
    numbers_.put_into(gltf);
    std::string json = json_text(gltf, -1);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string& numbers = numbers_.bytes();  // floats: whole words
    std::string out = "glTF";
    append(out, 2);
    append(out, 12 + 8 + json.size() + 8 + numbers.size());
    append(out, json.size());
    out += "JSON" + json;
    append(out, numbers.size());
    out += std::string("BIN\0", 4) + numbers;
    return out;
  }

 private:
  static void append(std::string& out, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    out.append(reinterpret_cast<const char*>(&word), sizeof(word));
  }
  static std::vector<float> rotations(const std::vector<MotionTrack::Pose>& poses, std::size_t joint) {
    std::vector<float> out;
    std::array<double, 4> last = {0, 0, 0, 1};
    for (const MotionTrack::Pose& pose : poses) {
      std::array<double, 4> q = quaternion(pose.turns[joint]);
      // q and -q are one turn: of the two the nearer one, for who interpolates.
      if (q[0] * last[0] + q[1] * last[1] + q[2] * last[2] + q[3] * last[3] < 0)
        for (double& value : q) value = -value;
      last = q;
      for (const double value : q) out.push_back(static_cast<float>(value));
    }
    return out;
  }
  void animate(std::size_t node, const char* what, const std::vector<float>& values, int width) {
    samplers_.push_back({{"input", times_}, {"output", numbers_.add(values, width)}});
    channels_.push_back({{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", what}}}});
  }

  std::size_t count_;
  GltfNumbers numbers_;
  std::size_t times_ = 0;
  std::vector<nlohmann::ordered_json> nodes_, skins_, channels_, samplers_;
  std::vector<std::size_t> roots_;
};

class Gltf final : public Sink {
 public:
  Gltf(PartialFile file, const TrackHeader& header) : file_(std::move(file)), tracks_(header) {}

  Result<void> write(const TrackedFrame& frame) override {
    tracks_.add(frame);
    return {};
  }

  Result<void> finish() override {
    const auto& tracks = tracks_.finished();
    GltfScene scene(std::max<std::size_t>(tracks_.count(), 1), tracks_.frame_s());
    for (const MotionTrack& track : tracks) scene.add(track);
    DUO_TRY(file_.write(scene.bytes()));
    return file_.publish();
  }

 private:
  PartialFile file_;
  MotionTracks tracks_;
};

}  // namespace

Result<std::unique_ptr<Sink>> make_gltf(const std::filesystem::path& path, const TrackHeader& header) {
  DUO_TRY_ASSIGN(PartialFile file, PartialFile::open(path));
  return std::unique_ptr<Sink>(std::make_unique<Gltf>(std::move(file), header));
}

}  // namespace duo
