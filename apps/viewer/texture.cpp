#include "texture.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <utility>

namespace duo::app::view {

Texture::~Texture() {
  if (name_ != 0) glDeleteTextures(1, &name_);
}

Result<void> Texture::set(View<const Rgb8> pixels) {
  const Size size = pixels.size();
  if (name_ == 0) glGenTextures(1, &name_);
  glBindTexture(GL_TEXTURE_2D, name_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(pixels.stride()));
  if (size == size_) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.width, size.height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    return {};
  }
  int most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (size.width > most || size.height > most)
    return Error{ErrorCode::kUnsupported,
                 fmt::format("cannot show a picture of {}x{}: the graphics driver takes at most {} pixels "
                             "per side; give it smaller pictures",
                             size.width, size.height, most)};
  for (const auto& [parameter, value] : {std::pair{GL_TEXTURE_MIN_FILTER, GL_LINEAR},
                                         {GL_TEXTURE_MAG_FILTER, GL_LINEAR},
                                         {GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE},
                                         {GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE}})
    glTexParameteri(GL_TEXTURE_2D, static_cast<GLenum>(parameter), value);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, size.width, size.height, 0, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  size_ = size;
  return {};
}

void Texture::draw(ImDrawList& list, ImVec2 from, ImVec2 to) const {
  if (!size_.empty()) list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(name_)), from, to);
}

}  // namespace duo::app::view
