// Frames of a source, one after the other.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <string_view>

#include "binding.h"
#include "duoptic/row_offsets.h"
#include "duoptic/sink_kinds.h"

namespace duo::python {
namespace {

/// The value of an enumeration by its names in its order.
///
/// Errors  none of these names, with all that there are
template <class T, std::size_t N>
T named(const std::array<std::string_view, N>& all, std::string_view name, const char* what) {
  std::string names;
  for (std::size_t i = 0; i < N; ++i) {
    if (all[i] == name) return static_cast<T>(i);
    names += (names.empty() ? "" : ", ") + std::string(all[i]);
  }
  refuse("there is no " + std::string(what) + " '" + std::string(name) + "'; there are " + names);
}

/// Where the pairs come from, and how to open them again.
struct Given {
  Input input;
  std::optional<Rig> rig;
  PairWish wish;
  std::string left, right;
  Input open() const { return value(open_input(left, right, rig, wish)); }
};

/// `keywords` loses those that say it.
Given open_given(const py::object& left, const py::object& right, py::dict& keywords) {
  Given given{.input = {}, .rig = {}, .wish = {}, .left = path_of(left, "left"), .right = path_of(right, "right")};
  given.rig = rig_of(take<py::object>(keywords, "rig", py::none()));
  const double skew_ms = take<double>(keywords, "skew_ms", 0);
  if (!(std::abs(skew_ms) <= 1e9)) refuse("skew_ms is not -1e9 .. 1e9");
  given.wish.skew_ns = std::llround(skew_ms * 1e6);
  if (const auto layout = take<std::optional<std::string>>(keywords, "layout", std::nullopt))
    given.wish.layout = named<ViewLayout>(kViewLayoutNames, *layout, "layout");
  const py::gil_scoped_release others_go_on;
  given.input = given.open();
  return given;
}

/// Of files without a rig: what their rows are off, where it matters.
std::optional<RowOffsets> rows_of(const Given& given, int threads) {
  if (given.input.rig || given.input.pairs->live()) return std::nullopt;
  const Input again = given.open();
  const RowOffsets rows = value(find_row_offsets(*again.pairs, std::max(threads, 1)));
  return rows.matter() ? std::optional(rows) : std::nullopt;
}

std::unique_ptr<Sink> sink_of(const std::string& target, Axes axes, const TrackHeader& header, std::string& note) {
  if (target.starts_with("osc://")) return value(make_osc(target.substr(6), axes));
  if (target.starts_with("vmc://")) return value(make_vmc(target.substr(6)));
  SinkTargets how;
  how.axes = axes;
  std::string endings;
  for (const SinkKind& kind : sink_kinds()) {
    if (!kind.is_file()) continue;
    if (target.ends_with(kind.target)) return value(kind.make(target, how, header, note));
    endings += kind.target + std::string(", ");
  }
  refuse("cannot write '" + target + "': no kind of output; there are " + endings + "osc://HOST:PORT and vmc://HOST:PORT");
}

/// The frames of one source. A call that comes while another thread is in one fails.
class Frames {
 public:
  Frames(Pipeline pipeline, double frame_s)
      : pipeline_(std::move(pipeline)), frame_s_(frame_s), live_(pipeline_.live()), count_(pipeline_.count()) {}

  Instant next() {
    const auto alone = lock();
    write_last();
    while (!ended_) {
      const Next next = made([&] { return pipeline_.next(); });
      if (next == Next::kNew) {
        to_write_ = has_frame_ = true;
        return last();
      }
      if (next == Next::kNothing) {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        continue;
      }
      cut_ = next == Next::kCut;
      end();
    }
    throw py::stop_iteration();
  }

  void close() {
    const auto alone = lock();
    end();
  }

  std::vector<Person> select(const std::map<std::string, std::pair<double, double>>& clicks, const std::string& arm) {
    const auto alone = lock();
    const Tracker* tracker = pipeline_.tracker();
    if (tracker == nullptr || tracker->starts_by_itself())
      refuse("cannot select: no tracker that follows clicks; give tracker='arm'");
    if (!has_frame_ || ended_) refuse("cannot select: there is no frame yet, or no more; call next() first");
    std::vector<std::string> texts;
    for (const auto& [joint, at] : clicks)
      texts.push_back(joint + "=" + std::to_string(at.first) + "," + std::to_string(at.second));
    const auto selections = value(parse_selections(texts, arm, tracker->skeletons()));
    with_gil_released([&] { return pipeline_.select(selections); });
    return {pipeline_.people().begin(), pipeline_.people().end()};
  }

  std::string add_sink(const py::object& target, const std::string& axes) {
    const auto alone = lock();
    if (ended_) refuse("cannot add an output: there are no more frames");
    if (pipeline_.tracker() == nullptr) refuse("cannot add an output: outputs are of people; give tracker");
    const std::string name = target.cast<std::filesystem::path>().string();
    std::string note;
    auto sink = sink_of(name, value(axes_of(axes)), pipeline_.header(), note);
    const Wants& wants = pipeline_.setup().wants;
    if (sink->wants_pictures() && !(wants.color && wants.views && wants.disparity))
      refuse("cannot write '" + name + "': it needs color, views and disparity; leave maps out, or name them");
    check(pipeline_.add_sink(name, std::move(sink)));
    return note;
  }

  void record(const std::filesystem::path& path, bool replace) {
    const auto alone = lock();
    if (ended_) refuse("cannot record: there are no more frames");
    RecorderSetup setup{.frame_s = frame_s_, .rig = pipeline_.setup().rig, .replace = replace};
    with_gil_released([&] { return pipeline_.record(path, setup); });
  }

  std::int64_t stop_recording() {
    const auto alone = lock();
    const py::gil_scoped_release others_go_on;
    pipeline_.stop_recording();
    if (const auto failure = pipeline_.recording_failure()) throw Failure(*failure);
    return pipeline_.recording().pairs;
  }

  // What stays the same is for any thread.
  const Setup& setup() const { return pipeline_.setup(); }
  const TrackHeader& header() const { return pipeline_.header(); }
  const std::optional<Rectified>& camera() const { return pipeline_.rectified(); }
  bool live() const { return live_; }
  std::int64_t count() const { return count_; }

  bool cut() const { return cut_; }
  std::int64_t dropped() const {
    const auto alone = lock();
    return pipeline_.dropped();
  }
  std::string warning() const {
    const auto alone = lock();
    return pipeline_.warning();
  }
  std::string doubts() const {
    const auto alone = lock();
    return pipeline_.rig_fit() ? pipeline_.rig_fit()->what : "";
  }

 private:
  std::unique_lock<std::mutex> lock() const {
    std::unique_lock alone(mutex_, std::try_to_lock);
    if (!alone) refuse("these frames are in use by another thread; one thread at a time may ask for them");
    return alone;
  }
  template <class Work>
  static void with_gil_released(Work&& work) {
    Result<void> done;
    {
      const py::gil_scoped_release others_go_on;
      done = work();
    }
    check(done);
  }
  /// After an error there are no more frames.
  template <class Work>
  Next made(Work&& work) {
    Result<Next> next = Next::kEnd;
    {
      const py::gil_scoped_release others_go_on;
      next = work();
    }
    if (!next) ended_ = true;
    return value(std::move(next));
  }
  /// The last frame goes to the outputs when the next is asked for: until then select() may give it people.
  void write_last() {
    if (std::exchange(to_write_, false)) with_gil_released([&] { return pipeline_.write(); });
  }
  /// Outputs take their names.
  void end() {
    if (std::exchange(ended_, true)) return;
    write_last();
    with_gil_released([&]() -> Result<void> {
      pipeline_.stop_recording();
      DUO_TRY(pipeline_.finish_sinks());
      if (auto failure = pipeline_.recording_failure()) return *failure;
      return {};
    });
  }
  Instant last() const {
    const TrackedFrame tracked = pipeline_.tracked();
    return {pipeline_.frame(), pipeline_.pair(), pipeline_.rectified(), {tracked.people.begin(), tracked.people.end()},
            tracked.number,    tracked.t_s};
  }

  mutable std::mutex mutex_;
  Pipeline pipeline_;
  double frame_s_;
  bool live_;
  std::int64_t count_;
  bool ended_ = false, cut_ = false, has_frame_ = false, to_write_ = false;
};

std::unique_ptr<Frames> open_frames(const py::object& left, const py::object& right, py::kwargs keywords) {
  Given given = open_given(left, right, keywords);
  Input& input = given.input;
  const MatchOptions options = MatchOptions::take_from(keywords);
  PipelineSetup setup;
  setup.names = input.names;
  setup.engine = options.engine;
  setup.threads = options.threads;
  setup.frames = options.setup(input.rig);
  setup.frames.many_at_once = true;
  setup.tracker = take<std::optional<std::string>>(keywords, "tracker", std::nullopt).value_or("");
  setup.body_model = named<BodyModel>(kBodyModelNames, take<std::string>(keywords, "model", "full"), "model");
  setup.first = take<std::int64_t>(keywords, "first", 0);
  setup.every = take<std::int64_t>(keywords, "every", 1);
  setup.check = take<bool>(keywords, "strict", false) ? RigCheck::kStrict : RigCheck::kTell;
  const bool keep_rows = take<bool>(keywords, "keep_rows", false);
  all_taken(keywords, "open");
  if (setup.first < 0 || setup.every < 1) refuse("first is not 0 or more, or every not 1 or more");
  const double frame_s = input.pairs->frame_s();
  const py::gil_scoped_release others_go_on;
  if (!keep_rows) setup.frames.rows = rows_of(given, options.threads);
  return std::make_unique<Frames>(value(Pipeline::open(std::move(input.pairs), std::move(setup))), frame_s);
}

std::int64_t record(const py::object& left, const py::object& right, const std::filesystem::path& path, py::kwargs keywords) {
  Given given = open_given(left, right, keywords);
  Input& input = given.input;
  const double seconds = take<double>(keywords, "seconds", 0);
  const bool replace = take<bool>(keywords, "replace", false);
  all_taken(keywords, "record");
  if (!(seconds >= 0)) refuse("seconds is not 0 or more");
  const RecorderSetup to_record{.frame_s = input.pairs->frame_s(), .rig = input.rig, .replace = replace};
  PipelineSetup setup{.names = input.names, .engine = ""};
  setup.frames.rig = input.rig;
  Pipeline pipeline = value(Pipeline::open(std::move(input.pairs), std::move(setup)));
  check(pipeline.record(path, to_record, seconds));
  for (Next next = Next::kNew; pipeline.recording().on && (next == Next::kNew || next == Next::kNothing);) {
    {
      const py::gil_scoped_release others_go_on;
      next = value(pipeline.next());
    }
    if (PyErr_CheckSignals() != 0) {
      pipeline.stop_recording();
      throw py::error_already_set();
    }
  }
  pipeline.stop_recording();
  if (const auto failure = pipeline.recording_failure()) throw Failure(*failure);
  return pipeline.recording().pairs;
}

}  // namespace

void add_frames(py::module_& module) {
  py::class_<Frames>(
      module, "Frames",
      "The frames of a source, in order: an iterator and a context manager. Outputs are complete, and files have their\n"
      "names, when the frames end or close() is called, which `with` does.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &Frames::next)
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](Frames& f, const py::args&) { f.close(); })
      .def("close", &Frames::close, "Completes all outputs; there are no more frames.")
      .def(
          "select", &Frames::select, py::arg("clicks"), py::arg("arm") = "right",
          "Follows an arm from clicks on the frame that next() gave last: {'hand': (x, y), 'elbow': (x, y), 'shoulder': (x, "
          "y)}, px of\n"
          "the raw left picture; arm: 'left' or 'right', the person's own, where names have no side. Gives the list of Person.")
      .def("add_sink", &Frames::add_sink, py::arg("target"), py::arg("axes") = "opencv",
           "Each frame from the last one on is written to `target`, too: a file that ends in .jsonl, .csv, .bvh, .glb, .trc or "
           ".mp4, or\n"
           "osc://HOST:PORT, vmc://HOST:PORT. axes, of .csv and osc: 'opencv', 'ros', 'opengl', 'unity' or 'blender'. Gives "
           "what its\n"
           "user should know of it, or ''.")
      .def("record", &Frames::record, py::arg("path"), py::arg("replace") = false,
           "Records the pairs, as they come, from now on; close() or stop_recording() ends it.")
      .def("stop_recording", &Frames::stop_recording, "Ends the recording; gives the number of its pairs.")
      .def_property_readonly(
          "size", [](const Frames& f) { return std::pair(f.setup().size.width, f.setup().size.height); },
          "(width, height) of each raw picture, px")
      .def_property_readonly(
          "rig", [](const Frames& f) { return f.setup().rig; }, "Rig, or None")
      .def_property_readonly("camera", &Frames::camera, "Pinhole of the maps, or None")
      .def_property_readonly(
          "engine", [](const Frames& f) { return f.header().engine; }, "'simd', 'vulkan' or 'ref'")
      .def_property_readonly("live", &Frames::live)
      .def_property_readonly("count", &Frames::count, "Pairs of the source; 0 = not known")
      .def_property_readonly("dropped", &Frames::dropped, "Pairs of a live source that nobody took in time")
      .def_property_readonly("cut", &Frames::cut, "After the end: the file was cut short; its whole pairs were given")
      .def_property_readonly("warning", &Frames::warning, "What there is to say of cameras or files, one line, or ''")
      .def_property_readonly("doubts", &Frames::doubts, "What the pairs so far say against the rig, one line, or ''");

  module.def(
      "open", &open_frames, py::arg("left"), py::arg("right") = py::none(),
      "open(left, right=None, *, rig=None, tracker=None, model='full', maps=None, engine='auto', threads=0, matcher='sgm',\n"
      "     preset='default', parameters={}, max_disparity=None, near_m=None, fill=False, first=0, every=1, strict=False,\n"
      "     skew_ms=0.0, layout=None, keep_rows=False) -> Frames\n\n"
      "Frames of two videos, pictures or cameras ('camera:0'), or of one recording. rig: a path or a Rig; a recording may "
      "bring\n"
      "its own. tracker: 'body', 'body_hands', 'arm' or 'thesis'. maps: of 'color', 'depth', 'disparity', 'views', "
      "'confidence',\n"
      "those that are wanted; without it all but confidence. near_m: how near things may be, m, in place of max_disparity, "
      "px.\n\n"
      "Errors: duoptic.Error with the line that the tool prints.");
  module.def("record", &record, py::arg("left"), py::arg("right"), py::arg("path"),
             "record(left, right, path, *, rig=None, seconds=0.0, replace=False, skew_ms=0.0, layout=None) -> int\n\n"
             "Records pairs of two cameras or files into one Matroska file; seconds 0: to the end, or until Ctrl-C. Gives the "
             "number of\n"
             "pairs.");
}

}  // namespace duo::python
