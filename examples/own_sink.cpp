// A sink of one's own: the pipeline hands it every frame, beside the file that another sink writes.
//   own_sink clip.mkv people.csv
#include <duoptic/duoptic.h>

#include <algorithm>
#include <cstdio>

/// Keeps how near anybody came.
class Nearest final : public duo::Sink {
 public:
  explicit Nearest(double& nearest_m) : nearest_m_(nearest_m) {}
  duo::Result<void> write(const duo::TrackedFrame& frame) override {
    for (const duo::Person& person : frame.people)
      for (std::size_t j = 0; j < person.count(); ++j)
        if (person.joints[j].state == duo::JointState::kSeen) nearest_m_ = std::min(nearest_m_, person.joints[j].p_in_rig_m.z);
    return {};
  }
  duo::Result<void> finish() override { return {}; }

 private:
  double& nearest_m_;
};

duo::Result<double> nearest_m_in(const char* clip, const char* table) {
  duo::PipelineSetup setup;
  setup.tracker = "body";
  DUO_TRY_ASSIGN(auto pairs, duo::open_pairs(clip, ""));
  DUO_TRY_ASSIGN(auto pipeline, duo::Pipeline::open(std::move(pairs), setup));
  double nearest_m = duo::kNoFarLimit_m;
  DUO_TRY(pipeline.add_sink("nearest", std::make_unique<Nearest>(nearest_m)));
  DUO_TRY_ASSIGN(auto csv, duo::make_csv(table, duo::Axes::kOpencv));
  DUO_TRY(pipeline.add_sink(table, std::move(csv)));
  while (true) {
    DUO_TRY_ASSIGN(const duo::Next next, pipeline.next());
    if (next == duo::Next::kNothing) continue;
    if (next != duo::Next::kNew) break;
    DUO_TRY(pipeline.write());
  }
  DUO_TRY(pipeline.finish_sinks());
  return nearest_m;
}

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "own_sink CLIP TABLE.csv\n"), 2;
  const auto nearest_m = nearest_m_in(argv[1], argv[2]);
  if (!nearest_m) return std::fprintf(stderr, "%s\n", nearest_m.error().what.c_str()), 1;
  std::printf("the nearest joint was %.2f m away\n", *nearest_m);
}
