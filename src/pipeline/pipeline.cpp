#include "duoptic/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "calib/rig_size.h"
#include "core/check.h"
#include "core/clock.h"
#include "pipeline/found_watch.h"
#include "pipeline/frame_stream.h"
#include "pipeline/pass_over.h"
#include "pipeline/picture_watch.h"
#include "pipeline/rig_watch.h"
#include "pipeline/tap.h"
#include "pipeline/tracked_setup.h"
#include "sinks/settled_bones.h"
#include "sources/file_source.h"

namespace duo {

struct Pipeline::State {
  struct NamedSink {
    std::string name;
    std::unique_ptr<Sink> sink;
  };

  PipelineSetup setup;
  TrackHeader header;
  std::unique_ptr<Engine> engine;
  std::unique_ptr<Tracker> tracker;
  std::shared_ptr<Recording> recording = std::make_shared<Recording>();
  std::vector<NamedSink> sinks;

  std::unique_ptr<FocusLine> focus;     // of frames, where the setup asks for it
  std::unique_ptr<PairSource> waiting;  // until the first next()
  std::unique_ptr<FrameStream> frames;  // after the engine, which it uses to its end
  Tap* tap = nullptr;                   // of frames
  Matched last;
  std::shared_ptr<const Pair> pair;  // last.pair
  std::vector<Person> people;
  double tracker_ms = 0;
  PictureWatch pictures;
  FoundWatch found;
  RigWatch watch;
  std::string rig_news, rig_news_before;  // before: of pairs that were passed over
  std::int64_t passed = 0;                // frames of sources before this one
  double passed_s = 0;

  const PairSource& source() const { return frames ? frames->source() : *waiting; }

  Result<void> prepare();
  Result<void> prepare_engine(const Setup& of_engine);
  Result<void> settle_focus();
  Result<void> prepare_tracker();
  Result<void> start();
  Result<void> look_at_rig(Next next);
  void keep(std::span<const Person> found);
};

Result<void> Pipeline::State::prepare() {
  Setup& of_engine = setup.frames;
  const bool live = waiting->live();
  of_engine.size = waiting->size();
  if (!of_engine.rig && !of_engine.rows) of_engine.rig = waiting->rig();
  of_engine.many_at_once &= !live;
  header.sources = setup.names;
  header.size = of_engine.size;
  header.frame_s = waiting->frame_s();
  header.live = live;
  header.metric = !of_engine.rig || of_engine.rig->metric;
  // A recording takes so little time that all points of three pairs would be a tenth of it.
  const bool quick = setup.engine.empty() && of_engine.rig.has_value();
  if (setup.check != RigCheck::kNone) watch = RigWatch(of_engine.rig, live, waiting->still(), quick);
  if (setup.engine.empty()) {
    const std::string why = of_engine.rig ? why_other_size(*of_engine.rig, of_engine.size) : "";
    return why.empty() ? Result<void>() : Error{ErrorCode::kBadInput, "cannot use the rig: " + why};
  }

  if (tracker != nullptr || !setup.tracker.empty()) {
    if (!of_engine.rig)
      return Error{ErrorCode::kBadInput,
                   fmt::format("cannot find joints in space with {}: it does not bring a rig; give one with --rig",
                               setup.names.empty() ? "the source" : setup.names[0])};
    if (tracker == nullptr) {
      DUO_TRY_ASSIGN(tracker, make_tracker(setup.tracker));
    }
    add_wants(tracker->wants(), of_engine.wants);
    of_engine = setup_of_tracked(of_engine);
    header.tracker = tracker->name();
    header.skeletons.assign(tracker->skeletons().begin(), tracker->skeletons().end());
  }
  if (setup.threads <= 0) setup.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  DUO_TRY_ASSIGN(engine, make_engine(setup.engine, setup.threads));
  DUO_TRY(prepare_engine(of_engine));
  DUO_TRY(settle_focus());
  header.engine = engine->name();
  header.device = engine->device();
  header.matcher = of_engine.matcher;
  header.matcher_preset = of_engine.preset;
  if (engine->rectified()) header.rectified = *engine->rectified();
  if (!live) found = FoundWatch(of_engine, header.rectified, tracker != nullptr && tracker->starts_by_itself());
  return prepare_tracker();
}

Result<void> Pipeline::State::prepare_engine(const Setup& of_engine) {
  if (frames) return frames->prepare(of_engine, last);  // each of its pairs comes with a focus
  DUO_TRY(engine->prepare(of_engine));
  if (header.focus) engine->focus({});  // from the first frame on
  return {};
}

Result<void> Pipeline::State::settle_focus() {
  if (setup.focus == PeopleFocus::kOff || tracker == nullptr) return {};
  std::string why_not;
  if (!tracker->starts_by_itself())
    why_not = fmt::format("the tracker {} does not follow whole people", tracker->name());
  else if (!engine->can_focus())
    why_not = fmt::format("the engine {} matches whole pictures with matcher {}; take engine simd and another matcher",
                          engine->name(), setup.frames.matcher);
  else if (setup.frames.fill)
    why_not = "to fill holes takes the whole picture; leave one of both out";
  if (setup.focus == PeopleFocus::kOn && !why_not.empty())
    return Error{ErrorCode::kUnsupported, fmt::format("cannot match around people alone: {}", why_not)};
  header.focus = why_not.empty() && (setup.focus == PeopleFocus::kOn || engine->device().empty());
  if (header.focus) engine->focus({});
  return {};
}

Result<void> Pipeline::State::prepare_tracker() {
  if (tracker == nullptr) return {};
  // The engine makes the next frame on all threads meanwhile: a layer of a network that is shared by as many would wait for
  // them.
  const int threads = std::max(1, setup.threads / 2);
  return tracker->prepare({*setup.frames.rig, header.rectified, tracked_frame_s(header.frame_s, setup.every), threads,
                           header.live, setup.body_model, setup.frames.time_stages});
}

/// The threads, at the first pair that is asked for.
Result<void> Pipeline::State::start() {
  if (frames) return {};
  DUO_CHECK(waiting != nullptr);
  int at_once = setup.frames.many_at_once && engine ? engine->in_flight() : 1;
  if (header.focus) {
    at_once = std::min(at_once, FocusLine::kBehind - 1);  // the frame that the next pair depends on must have been tracked
    focus = std::make_unique<FocusLine>(header.rectified, header.frame_s * static_cast<double>(setup.every), header.live);
  }
  FrameStream::Passed passed;
  if (auto* const files = dynamic_cast<FilePairs*>(waiting.get());
      files != nullptr && !header.live && !recording->status().on) {
    DUO_TRY_ASSIGN(passed, pass_over(*files, {setup.first, setup.every}, watch, rig_news_before));
  }
  auto tapped = std::make_unique<Tap>(std::move(waiting), recording);
  tap = tapped.get();
  frames = std::make_unique<FrameStream>(std::move(tapped), engine.get(), at_once,
                                         FrameStream::Choice{setup.first, setup.every, setup.budget_percent / 100},
                                         std::move(passed), focus.get());
  if (!setup.in_turn) frames->start();
  return {};
}

Result<void> Pipeline::State::look_at_rig(Next next) {
  rig_news = std::exchange(rig_news_before, {});
  if (next == Next::kNothing) return {};
  if (const RigFit* const news = next == Next::kNew ? watch.see(pair, source().still()) : watch.end()) rig_news = news->what;
  if (setup.check != RigCheck::kStrict) return {};
  rig_news.clear();  // the error says it, with the same frame in every run
  const auto& fit = watch.fit();
  return fit && !fit->what.empty() ? Result<void>(Error{ErrorCode::kBadInput, fit->what}) : Result<void>();
}

void Pipeline::State::keep(std::span<const Person> found) {
  people.assign(found.begin(), found.end());
  if (const auto& fit = watch.fit(); fit && fit->disparity_sigma_px > 0)
    widen(people, header.rectified, fit->disparity_sigma_px);
}

Pipeline::Pipeline(std::unique_ptr<State> state) : state_(std::move(state)) {}
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;
Pipeline::~Pipeline() = default;

Result<Pipeline> Pipeline::open(std::unique_ptr<PairSource> pairs, PipelineSetup setup, std::unique_ptr<Tracker> tracker) {
  auto state = std::make_unique<State>();
  state->setup = std::move(setup);
  state->setup.every = std::max<std::int64_t>(1, state->setup.every);
  state->waiting = std::move(pairs);
  state->tracker = std::move(tracker);
  DUO_TRY(state->prepare());
  return Pipeline(std::move(state));
}

Result<Next> Pipeline::next() {
  State& s = *state_;
  DUO_TRY(s.start());
  DUO_TRY_ASSIGN(const Next next, s.frames->next(s.last));
  if (next == Next::kNew) {
    s.pair = s.last.pair;
    s.pictures.see(*s.pair, live());
  }
  DUO_TRY(s.look_at_rig(next));
  if (next == Next::kEnd || next == Next::kCut) s.found.end();
  if (next != Next::kNew) return next;
  if (s.tracker == nullptr) {
    if (s.last.frame) s.found.see(*s.last.frame, *s.pair, 0);
    return next;
  }
  const std::int64_t begin_ns = wall_ns();
  s.keep(s.tracker->track(*s.last.frame));
  if (s.focus) s.focus->tell(s.people, s.last.frame->t_ns);
  s.tracker_ms = static_cast<double>(wall_ns() - begin_ns) * 1e-6;
  s.found.see(*s.last.frame, *s.pair, s.people.size());
  return next;
}

void Pipeline::wait() { state_->frames->wait(); }
const std::shared_ptr<const Frame>& Pipeline::frame() const { return state_->last.frame; }
const std::shared_ptr<const Pair>& Pipeline::pair() const { return state_->pair; }
std::span<const Person> Pipeline::people() const { return state_->people; }
const Tracker* Pipeline::tracker() const { return state_->tracker.get(); }
TrackTimes Pipeline::times() const { return {state_->last.engine_ms, state_->tracker_ms}; }
std::string Pipeline::event() const { return state_->last.event; }
const std::optional<RigFit>& Pipeline::rig_fit() const { return state_->watch.fit(); }
const std::string& Pipeline::rig_news() const { return state_->rig_news; }

TrackedFrame Pipeline::tracked() const {
  const Pair& pair = *state_->pair;
  return {static_cast<std::int64_t>(pair.sequence),
          static_cast<double>(pair.left.t_ns - state_->frames->start_ns()) * 1e-9,
          {state_->pair, &pair.left},
          state_->last.frame,
          state_->people,
          state_->setup.tell_times ? std::optional(times()) : std::nullopt};
}

Result<void> Pipeline::select(std::span<const Selection> selections) {
  State& s = *state_;
  DUO_CHECK(s.tracker != nullptr && s.last.frame != nullptr);
  const std::int64_t begin_ns = wall_ns();
  const auto found = s.tracker->select(*s.last.frame, selections);
  if (!found) {  // a rig that does not fit leaves no depth to select in
    s.watch.end();
    const auto& fit = s.watch.fit();
    return fit && !fit->what.empty() ? Error{found.error().code, found.error().what + "; " + fit->what} : found.error();
  }
  s.keep(*found);
  s.tracker_ms = static_cast<double>(wall_ns() - begin_ns) * 1e-6;
  return {};
}

void Pipeline::forget() {
  if (state_->tracker) state_->tracker->reset();
  if (state_->focus) state_->focus->forget();
  state_->people.clear();
}

Result<void> Pipeline::set(const std::vector<std::pair<std::string, double>>& parameters) {
  State& s = *state_;
  Setup setup = s.setup.frames;
  setup.parameters = parameters;
  if (s.tracker) setup = setup_of_tracked(setup);
  DUO_TRY(s.prepare_engine(setup));
  s.setup.frames = std::move(setup);
  return {};
}

void Pipeline::look_at(std::span<const Window> windows) {
  DUO_CHECK(state_->frames == nullptr);
  if (!windows.empty()) state_->found = {};  // nothing is known elsewhere
  state_->engine->look_at(windows);
}

Result<void> Pipeline::add_sink(std::string name, std::unique_ptr<Sink> sink) {
  if (live() && !sink->instant()) {
    DUO_TRY_ASSIGN(sink, in_background(std::move(sink)));
  }
  if (!live() && state_->tracker)
    sink = with_settled_bones(std::move(sink), state_->setup.frames.rig, state_->header.rectified);
  state_->sinks.push_back({std::move(name), std::move(sink)});
  return {};
}

std::vector<std::string> Pipeline::sink_names() const {
  std::vector<std::string> names;
  for (const State::NamedSink& sink : state_->sinks) names.push_back(sink.name);
  return names;
}

bool Pipeline::has_sink(std::string_view name) const {
  return std::any_of(state_->sinks.begin(), state_->sinks.end(), [&](const auto& sink) { return sink.name == name; });
}

Result<void> Pipeline::write() {
  State& s = *state_;
  TrackedFrame frame = tracked();
  frame.number += s.passed;
  frame.t_s += s.passed_s;
  Result<void> first;
  std::erase_if(s.sinks, [&](const State::NamedSink& sink) {
    const Result<void> written = sink.sink->write(frame);
    if (!written && first) first = written;
    return !written;
  });
  return first;
}

Result<void> Pipeline::finish_sink(std::string_view name) {
  Result<void> first;
  std::erase_if(state_->sinks, [&](const State::NamedSink& sink) {
    if (sink.name != name) return false;
    if (const Result<void> finished = sink.sink->finish(); !finished && first) first = finished;
    return true;
  });
  return first;
}

Result<void> Pipeline::flush_sinks() {
  Result<void> first;
  for (const State::NamedSink& sink : state_->sinks)
    if (const Result<void> flushed = sink.sink->flush(); !flushed && first) first = flushed;
  return first;
}

Result<void> Pipeline::finish_sinks() {
  Result<void> first;
  for (const State::NamedSink& sink : state_->sinks)
    if (const Result<void> finished = sink.sink->finish(); !finished && first) first = finished;
  return first;
}

std::vector<std::pair<std::string, std::int64_t>> Pipeline::dropped_by_sinks() const {
  std::vector<std::pair<std::string, std::int64_t>> out;
  for (const auto& [name, sink] : state_->sinks)
    if (sink->dropped() > 0) out.emplace_back(name, sink->dropped());
  return out;
}

Result<void> Pipeline::record(const std::filesystem::path& path, const RecorderSetup& setup, double most_s) {
  DUO_TRY(state_->recording->start(path, setup, most_s));
  DUO_TRY(state_->start());  // a live source is recorded before anybody asks for a frame
  return state_->tap->read_all_pairs();
}

void Pipeline::stop_recording() { state_->recording->stop(); }
RecordingStatus Pipeline::recording() const { return state_->recording->status(); }
std::optional<Error> Pipeline::recording_failure() const { return state_->recording->first_failure(); }

void Pipeline::close_source() {
  State& s = *state_;
  if (s.pair) {
    s.passed += static_cast<std::int64_t>(s.pair->sequence) + 1;
    s.passed_s += static_cast<double>(s.pair->sequence + 1) * s.header.frame_s;
  }
  s.frames.reset();
  s.waiting.reset();
  s.pair.reset();
  s.pictures = {};
  s.found.forget();
  s.last = {};
  s.people.clear();
}

Result<void> Pipeline::restart(std::unique_ptr<PairSource> pairs, std::int64_t first) {
  State& s = *state_;
  close_source();
  s.setup.first = first;
  if (pairs->size() != s.header.size)
    return Error{ErrorCode::kBadInput,
                 fmt::format("cannot start again: the pictures were {}x{} and are {}x{} now", s.header.size.width,
                             s.header.size.height, pairs->size().width, pairs->size().height)};
  s.waiting = std::move(pairs);
  return s.prepare_tracker();
}

const TrackHeader& Pipeline::header() const { return state_->header; }
const Setup& Pipeline::setup() const { return state_->setup.frames; }
const std::optional<Rectified>& Pipeline::rectified() const { return state_->engine->rectified(); }
bool Pipeline::live() const { return state_->header.live; }
bool Pipeline::still() const { return state_->source().still(); }
std::int64_t Pipeline::count() const { return state_->source().count(); }
std::int64_t Pipeline::read() const { return state_->frames ? state_->frames->read() : 0; }
std::int64_t Pipeline::dropped() const {
  return state_->source().dropped() + (state_->frames ? state_->frames->left_out() : 0);
}
std::string Pipeline::warning() const {
  const auto& fit = state_->watch.fit();
  std::string all;
  for (const std::string& one : {state_->source().warning(), state_->pictures.warning(live()),
                                 state_->found.warning(fit && fit->verdict == RigVerdict::kRecalibrate)})
    all += (all.empty() || one.empty() ? "" : "; ") + one;
  return all;
}

}  // namespace duo
