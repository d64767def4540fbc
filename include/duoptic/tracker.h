// The tracker turns frames into persons.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "duoptic/detector.h"
#include "duoptic/engine.h"
#include "duoptic/frame.h"
#include "duoptic/person.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"
#include "duoptic/skeleton.h"

namespace [[gnu::visibility("default")]] duo {

/// Where the user clicked on a joint, raw left pixels.
struct Click {
  JointId joint = JointId::kPelvis;
  double x_px = 0, y_px = 0;
};

/// One person to be tracked.
struct Selection {
  const Skeleton* skeleton = nullptr;  // one of Tracker::skeletons()
  std::vector<Click> clicks;           // each of its joints once, in any order
};

/// Reads clicks such as "right_hand=451,360"; a joint without a side, "hand=451,360", is that of `side` ("left" or "right").
/// Gives a selection per skeleton, in the order in which they are named.
///
/// Errors  not JOINT=X,Y; no such joint, with those that there are; a joint twice or missing
Result<std::vector<Selection>> parse_selections(const std::vector<std::string>& texts, const std::string& side,
                                                std::span<const Skeleton* const> skeletons);

/// The names of all joints of skeletons: "right_shoulder, right_elbow, …".
std::string joint_names(std::span<const Skeleton* const> skeletons);

struct TrackerSetup {
  Rig rig;
  Rectified rectified;                      // of the frames to come
  double frame_s = 1.0 / 30;                // from one tracked frame to the next
  int threads = 1;                          // that the tracker may use; the result does not depend on them
  bool live = false;                        // a result that comes late is worth less
  BodyModel body_model = BodyModel::kFull;  // of trackers that have networks
  bool time_stages = false;
};

/// Follows persons through frames that have what the tracker wants.
///
/// Errors   all that can fail is in prepare() and select(); a failed call leaves the tracker as it was
/// Threads  one caller
class Tracker {
 public:
  virtual ~Tracker() = default;
  virtual const char* name() const = 0;
  /// What its persons may have.
  virtual std::span<const Skeleton* const> skeletons() const = 0;
  /// Whether track() finds persons without select().
  virtual bool starts_by_itself() const { return false; }
  /// What its frames must have.
  virtual Wants wants() const = 0;
  virtual Result<void> prepare(const TrackerSetup& setup) = 0;
  /// Starts tracking from clicks on this frame and forgets the persons before. Gives the persons in this frame, in the order
  /// of `selections`: track() is called from the next frame on. Valid until the next call.
  ///
  /// Errors  a click outside the picture, or where the frame has no depth nearby: which joint, and what to do
  virtual Result<std::span<const Person>> select(const Frame& frame, std::span<const Selection> selections) = 0;
  /// The persons in this frame. Valid until the next call.
  virtual std::span<const Person> track(const Frame& frame) = 0;
  /// Forgets everybody. Who is found without a click from then on has a number that nobody had before.
  virtual void reset() = 0;
  /// Times of the last track(), and of trackers on a device of select(), where stages are timed; the list ends at the first
  /// wall_ns of 0.
  virtual std::span<const StageTime> stages() const { return {}; }
};

/// Makes a tracker by name: "body" (whole people, found by themselves), "body_hands" (the same with their fingers), "arm"
/// (hand, elbow and shoulder of one or two arms that are clicked, through hiding), "thesis" (the method of 2010).
///
/// Errors  unknown name, with the known ones
Result<std::unique_ptr<Tracker>> make_tracker(std::string_view name);
std::vector<std::string> tracker_names();

}  // namespace duo
