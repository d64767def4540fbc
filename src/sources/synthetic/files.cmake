target_sources(duoptic PRIVATE
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/backdrop.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/blend.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/clip.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/figure.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/figure_textures.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/furniture.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/lens.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/live_clip.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/light.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/mounting.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/noise.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/patterns.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/projector.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/render.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/room.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/scene.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/script.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/shading.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/shapes.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/bones.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/synthetic.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/textures.cpp
  ${PROJECT_SOURCE_DIR}/src/sources/synthetic/webcam.cpp)
duoptic_test(sources/synthetic ${PROJECT_SOURCE_DIR}/src/sources/synthetic/synthetic_test.cpp)
duoptic_test(sources/synthetic_clip ${PROJECT_SOURCE_DIR}/src/sources/synthetic/clip_test.cpp)
duoptic_test(sources/synthetic_whole_body ${PROJECT_SOURCE_DIR}/src/sources/synthetic/whole_body_test.cpp)
