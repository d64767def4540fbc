# OpenCV by modules: Debian's OpenCVConfig.cmake comes only with libopencv-dev, which pulls in every module and its
# dependencies; the modules we use have their own small packages. Gives the targets opencv::core, opencv::imgproc, …
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
set(opencv_modules core imgproc calib3d)
if(DUO_TESTS)
  list(APPEND opencv_modules features2d imgcodecs)  # its SIFT is held against ours, and it reads the PNGs we write
endif()
foreach(module ${opencv_modules})
  find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
  add_library(opencv::${module} UNKNOWN IMPORTED)
  set_target_properties(opencv::${module} PROPERTIES
    IMPORTED_LOCATION ${OPENCV_${module}_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR})
endforeach()
