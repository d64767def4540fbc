// Frames of arrays.
#include <algorithm>
#include <cstring>
#include <mutex>
#include <thread>

#include "binding.h"
#include "duoptic/source.h"

namespace duo::python {
namespace {

/// Errors  not uint8 of H x W x 3 or H x W; another size than `size`
Picture picture_of(const py::array& array, const char* name, Size size) {
  const bool gray = array.ndim() == 2, color = array.ndim() == 3 && array.shape(2) == 3;
  const std::string got = std::string(name) + " is " + py::str(array.dtype()).cast<std::string>() + " of shape " +
                          py::str(array.attr("shape")).cast<std::string>();
  if (!array.dtype().is(py::dtype::of<std::uint8_t>()) || (!gray && !color))
    refuse(got + ", not uint8 of (height, width, 3) or (height, width)");
  if (array.shape(0) != size.height || array.shape(1) != size.width)
    refuse(got + ", not of the " + std::to_string(size.width) + "x" + std::to_string(size.height) + " px that were announced");
  const auto rows = py::array_t<std::uint8_t, py::array::c_style>::ensure(array);
  Picture picture{.pixels = Image<Rgb8>(size)};
  const std::uint8_t* from = rows.data();
  for (int y = 0; y < size.height; ++y) {
    Rgb8* to = picture.pixels.row(y);
    if (color) {
      std::memcpy(to, from, static_cast<std::size_t>(size.width) * 3);
      from += std::ptrdiff_t{size.width} * 3;
    } else {
      for (int x = 0; x < size.width; ++x, ++from) to[x] = {*from, *from, *from};
    }
  }
  return picture;
}

/// Makes frames of pairs of arrays of one size.
class ArrayEngine {
 public:
  ArrayEngine(std::pair<int, int> size, py::kwargs keywords) : size_{size.first, size.second} {
    if (size_.width < 1 || size_.height < 1 || std::int64_t{size_.width} * size_.height > kMostPixels)
      refuse("size is not (width, height) of a picture");
    const auto rig = rig_of(take<py::object>(keywords, "rig", py::none()));
    const MatchOptions options = MatchOptions::take_from(keywords);
    all_taken(keywords, "Engine");
    Setup setup = options.setup(rig);
    setup.size = size_;
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const py::gil_scoped_release others_go_on;
    engine_ = value(make_engine(options.engine, options.threads > 0 ? options.threads : cores));
    check(engine_->prepare(setup));
  }

  Instant run(const py::array& left, const py::array& right) {
    std::unique_lock alone(mutex_, std::try_to_lock);
    if (!alone) refuse("this engine is in use by another thread; one thread at a time may use it");
    auto pair = std::make_shared<Pair>();
    pair->left = picture_of(left, "left", size_);
    pair->right = picture_of(right, "right", size_);
    pair->sequence = static_cast<std::uint64_t>(number_);
    std::shared_ptr<const Frame> frame;
    {
      const py::gil_scoped_release others_go_on;
      engine_->submit(*pair);
      frame = engine_->collect();
    }
    return {std::move(frame), std::move(pair), engine_->rectified(), {}, number_++, 0};
  }

 private:
  std::mutex mutex_;
  Size size_;
  std::unique_ptr<Engine> engine_;
  std::int64_t number_ = 0;
};

}  // namespace

void add_engine(py::module_& module) {
  py::class_<ArrayEngine>(
      module, "Engine",
      "Engine(size, *, rig=None, engine='auto', threads=0, ...): makes frames of pairs of arrays, all of one size\n"
      "(width, height). Keywords are those of open(). Without a rig a pair is taken as rectified.")
      .def(py::init<std::pair<int, int>, py::kwargs>(), py::arg("size"))
      .def("__call__", &ArrayEngine::run, py::arg("left"), py::arg("right"),
           "The Frame of two pictures, uint8 (height, width, 3) RGB or (height, width) gray.");
}

}  // namespace duo::python
