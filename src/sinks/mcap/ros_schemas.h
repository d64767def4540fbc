// Definitions of the ROS 2 messages that the MCAP sink writes, with those that they contain, as a file of them must carry them.
#pragma once

#include <string>
#include <string_view>

namespace duo::ros {

inline constexpr std::string_view kTime = "builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
inline constexpr std::string_view kDuration = "builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n";
inline constexpr std::string_view kHeader = "std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";
inline constexpr std::string_view kVector3 = "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
inline constexpr std::string_view kPoint = "geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n";
inline constexpr std::string_view kQuaternion = "geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
inline constexpr std::string_view kPose =
    "geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n";
inline constexpr std::string_view kTransform =
    "geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n";
inline constexpr std::string_view kTransformStamped =
    "geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n";
inline constexpr std::string_view kColor = "std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n";
inline constexpr std::string_view kRegion =
    "sensor_msgs/RegionOfInterest\nuint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n";
inline constexpr std::string_view kField = "sensor_msgs/PointField\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n";
inline constexpr std::string_view kCompressedImage =
    "sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n";
inline constexpr std::string_view kUv = "visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n";
inline constexpr std::string_view kMesh = "visualization_msgs/MeshFile\nstring filename\nuint8[] data\n";
inline constexpr std::string_view kMarker =
    "visualization_msgs/Marker\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose "
    "pose\n"
    "geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\n"
    "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\n"
    "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nvisualization_msgs/MeshFile "
    "mesh_file\n"
    "bool mesh_use_embedded_materials\n";

inline constexpr std::string_view kImage =
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data\n";
inline constexpr std::string_view kCameraInfo =
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\nfloat64[9] k\nfloat64[9] r\n"
    "float64[12] p\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n";
inline constexpr std::string_view kCloud =
    "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 "
    "point_step\n"
    "uint32 row_step\nuint8[] data\nbool is_dense\n";

/// A definition and those it contains; each of these begins with its name.
template <class... Contained>
std::string with(std::string_view definition, Contained... contained) {
  std::string out(definition);
  for (const std::string_view other : {std::string_view(contained)...})
    out += std::string(80, '=') + "\nMSG: " + std::string(other);
  return out;
}

}  // namespace duo::ros
