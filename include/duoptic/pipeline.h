// The whole way of a frame: source → align in time → engine → tracker → sinks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "duoptic/engine.h"
#include "duoptic/recording.h"
#include "duoptic/rig_fit.h"
#include "duoptic/sink.h"
#include "duoptic/source.h"
#include "duoptic/tracker.h"

namespace [[gnu::visibility("default")]] duo {

/// What is done with what rig_fit() finds in the first second, and of a live source every minute.
enum class RigCheck : std::uint8_t {
  kNone,    // it is not looked at
  kTell,    // Pipeline::rig_fit() has it; joints are as much less sure
  kStrict,  // and next() ends with an error where the verdict is not good
};

/// Whether frames are matched around the people of frames before and nowhere else, every 16th as a whole, every fourth while
/// nothing is seen of somebody.
enum class PeopleFocus : std::uint8_t {
  kOff,
  kWherePossible,  // by the CPU, with a tracker that finds people by itself, a matcher that can, and holes left open
  kOn,             // or Pipeline::open() says what is in the way; the CPU makes the frames
};

struct PipelineSetup {
  std::vector<std::string> names = {};  // of the source's parts, left first, for the sinks
  std::string engine = "auto";          // see make_engine(); empty: pairs without frames
  int threads = 0;                      // of the engine; 0: one per core
  Setup frames = {};         // of the engine. The source sets its size and, without rig and rows, its rig; the tracker adds
                             // what it wants; many_at_once is for files
  std::string tracker = {};  // see make_tracker(); empty: none
  BodyModel body_model = BodyModel::kFull;  // of a tracker with networks
  std::int64_t first = 0;                   // pairs before this number are passed over
  std::int64_t every = 1;                   // and of those from there on, all but every N-th
  PeopleFocus focus = PeopleFocus::kOff;    // TrackHeader::focus tells what became of it
  double budget_percent = 0;                // of a live source: pairs are left out so that the process takes no more CPU time
                                            // than this, 100 being one core; 0: no limit
  bool in_turn = false;     // what runs in threads side by side runs in the caller's, in turn: to measure what each part costs
  bool tell_times = false;  // to the sinks: times differ from run to run
  RigCheck check = RigCheck::kNone;
};

/// Of the recording that runs, or ran last.
struct RecordingStatus {
  bool on = false;
  std::string name = {};  // of its file; empty: there was none
  std::int64_t pairs = 0, bytes = 0;
  std::int64_t dropped = 0;  // pairs that the source lost meanwhile
  double length_s = 0;       // from the first pair's capture to the last one's
  std::string codecs = {};   // once it is complete
  std::string problem = {};  // empty: none
};

/// Pairs, frames and tracked persons of one source. Of files each pair is given once, in order, with the same bits for any
/// number of threads; a live source gives its newest pair, and dropped() counts the others: PairSource::live() decides. The
/// next frame is made while the last one is worked on; it is shared, and may be kept.
///
/// Threads  one caller, and any for recording()
class Pipeline {
 public:
  /// `tracker`: one of the caller's own, in place of the one that `setup` names.
  ///
  /// Errors  those of make_engine(), Engine::prepare(), make_tracker() and Tracker::prepare(); a tracker without a rig
  static Result<Pipeline> open(std::unique_ptr<PairSource> pairs, PipelineSetup setup,
                               std::unique_ptr<Tracker> tracker = nullptr);
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;
  ~Pipeline();

  /// The next frame, tracked. As PairSource::next(): kNothing of a live source means to ask again. Not to be called again after
  /// the end or an error.
  ///
  /// Errors  those of PairSource::next(); the system gives no thread; no memory; RigCheck::kStrict: the rig does not fit
  Result<Next> next();
  /// Waits until the next frame is ready; then nothing goes on until next(), unless many are made at once.
  void wait();

  // Of the last frame that next() gave:

  const std::shared_ptr<const Frame>& frame() const;
  const std::shared_ptr<const Pair>& pair() const;  // as it came
  std::span<const Person> people() const;
  TrackedFrame tracked() const;
  TrackTimes times() const;   // of the engine, from when it had the pair; of the tracker
  std::string event() const;  // Engine::take_event()
  /// What the pairs so far say of the rig; none: not yet judged. Of files it comes with the same frame in every run, of a
  /// picture with its frame, and of a short file with its end.
  const std::optional<RigFit>& rig_fit() const;
  /// RigFit::what of another verdict, once, as soon as it is known: of files up to half a second before rig_fit() has it. Empty
  /// with RigCheck::kStrict, whose error says it.
  const std::string& rig_news() const;
  /// Tracks from clicks on this frame; see Tracker::select().
  Result<void> select(std::span<const Selection> selections);
  /// Forgets who was selected and who was found.
  void forget();
  /// Other parameters of the matcher, by name; this frame is made anew with them, and those that follow are; tracking goes on.
  ///
  /// Errors  those of Engine::prepare(); then all is as it was
  Result<void> set(const std::vector<std::pair<std::string, double>>& parameters);

  /// Before the first next(): only these windows matter; see Engine::look_at().
  void look_at(std::span<const Window> windows);

  /// Adds an output. One of a live source that may have to wait gets a thread of its own; one of files that wants no pictures
  /// is given each frame up to 75 frames later, 2.5 s at 30 per second, with the bones' lengths that were learnt meanwhile.
  ///
  /// Errors  the system gives no thread
  Result<void> add_sink(std::string name, std::unique_ptr<Sink> sink);
  bool has_sink(std::string_view name) const;
  /// Hands the last frame to all sinks. One that fails is given up; the others have the frame.
  ///
  /// Errors  the first that a sink had
  Result<void> write();
  /// Writes what waits in outputs for later frames, where no later one comes and they are not to be completed.
  ///
  /// Errors  those of Sink::flush()
  Result<void> flush_sinks();
  /// Of the outputs that there still are.
  std::vector<std::string> sink_names() const;
  /// Completes one output, or all.
  ///
  /// Errors  those of Sink::finish()
  Result<void> finish_sink(std::string_view name);
  Result<void> finish_sinks();
  /// Frames that sinks left out, by name; only of sinks that did.
  std::vector<std::pair<std::string, std::int64_t>> dropped_by_sinks() const;

  /// Records the pairs from now on: all that a live source gives, also those that nobody takes in time; of files those that are
  /// read. Ends by itself after `most_s`, where that is not 0.
  ///
  /// Errors  those of Recorder::open(); the system gives no thread
  Result<void> record(const std::filesystem::path& path, const RecorderSetup& setup, double most_s = 0);
  void stop_recording();
  RecordingStatus recording() const;
  /// The first failure of any recording; tracking goes on after it.
  std::optional<Error> recording_failure() const;

  /// Lets the source go, before the same is opened again.
  void close_source();
  /// From pair `first` of another source of the same pictures, which is reached as PipelineSetup::first is; sinks go on
  /// counting frames. The tracker forgets.
  ///
  /// Errors  its pictures have another size; those of Tracker::prepare()
  Result<void> restart(std::unique_ptr<PairSource> pairs, std::int64_t first = 0);

  const Tracker* tracker() const;  // null: none
  const TrackHeader& header() const;
  const Setup& setup() const;  // of the engine, as it is now
  const std::optional<Rectified>& rectified() const;
  bool live() const;
  bool still() const;
  std::int64_t count() const;    // pairs of the source; 0: not known
  std::int64_t read() const;     // pairs of the source, before its end
  std::int64_t dropped() const;  // pairs of a live source that nobody took in time, or that were left out for the budget
  /// PairSource::warning(), and of which camera pictures repeat while the other's move: it hangs, or was slower.
  std::string warning() const;

 private:
  struct State;
  explicit Pipeline(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace duo
