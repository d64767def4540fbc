// Where the pixels of a window's scale space lie.

// The part of the picture that a window looks at.
struct Part {
  ivec4 window;  // inside the picture: columns [x, z) of rows [y, w)
  ivec2 corner;  // of the blurred part, in the picture
  ivec2 size;    // of octave 0; 0 for an empty window and for one that is larger than there is room
};

Part part_of(SiftShape shape, ivec4 window) {
  const ivec2 picture = ivec2(shape.width, shape.height);
  const int grid = 1 << (shape.octaves - 1);
  Part part;
  part.window = ivec4(max(window.xy, ivec2(0)), min(window.xy + window.zw, picture));
  const ivec2 extent = part.window.zw - part.window.xy;
  part.corner = max(part.window.xy - shape.margin_px, ivec2(0)) / grid * grid;
  part.size = min(part.window.zw + shape.margin_px, picture) - part.corner;
  const bool fits = part.size.x <= shape.room_width && part.size.y <= shape.room_height;
  if (extent.x <= 0 || extent.y <= 0 || !fits) part.size = ivec2(0);
  return part;
}

// Of the part in an octave; 0 where there is no such octave.
ivec2 size_of(Part part, int octave) {
  ivec2 size = part.size;
  for (int k = 0; k < octave; ++k) {
    if (min(size.x, size.y) / 2 < kSiftSmallest) return ivec2(0);
    size = (size + 1) / 2;
  }
  return size;
}

ivec2 room_of(SiftShape shape, int octave) {
  return (ivec2(shape.room_width, shape.room_height) + (1 << octave) - 1) >> octave;
}

// Blurred planes are 0 .. kSiftBlurred - 1, differences follow.
Plane plane_of(SiftShape shape, int window, int octave, int plane) {
  const ivec2 room = room_of(shape, octave);
  const int before = window * sift_pixels_before(shape, shape.octaves) + sift_pixels_before(shape, octave);
  return Plane(kSiftPlanes * before + plane * room.x * room.y, room.x);
}

// Positions of possible extrema in the order of their points: octave, level, y, x.
struct Position {
  int octave, level;
  ivec2 at;
};

int positions_in(SiftShape shape) { return kSiftLevels * sift_pixels_before(shape, shape.octaves); }

Position position_of(SiftShape shape, int index) {
  int octave = 0;
  for (; octave + 1 < shape.octaves && index >= kSiftLevels * sift_pixels_before(shape, octave + 1); ++octave) {
  }
  index -= kSiftLevels * sift_pixels_before(shape, octave);
  const ivec2 room = room_of(shape, octave);
  const int pixels = room.x * room.y, pixel = index % pixels;
  return Position(octave, 1 + index / pixels, ivec2(pixel % room.x, pixel / room.x));
}

int index_of(SiftShape shape, Position position) {
  const ivec2 room = room_of(shape, position.octave);
  return kSiftLevels * sift_pixels_before(shape, position.octave) + ((position.level - 1) * room.y + position.at.y) * room.x +
         position.at.x;
}
