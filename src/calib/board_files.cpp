// A page as SVG, PDF and PNG. All black is one path: as single shapes their common edges would shine through on a screen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "calib/board_page.h"
#include "core/coded_picture.h"
#include "core/file.h"
#include "duoptic/stdout.h"

extern "C" {
#include <libavutil/crc.h>
}

namespace duo {
namespace {

constexpr int kPixelsPerMm = 10;

std::string escaped_xml(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return out;
}

std::string escaped_pdf(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '(' || c == ')' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return out;
}

/// Darkens each pixel by the share of it that the rectangle covers.
void fill(cv::Mat& ink, const PageRect& rect) {
  const double left = rect.x_mm * kPixelsPerMm, top = rect.y_mm * kPixelsPerMm;
  const double right = left + rect.width_mm * kPixelsPerMm, bottom = top + rect.height_mm * kPixelsPerMm;
  const auto covered = [](double from, double to, int pixel) {
    return std::max(0.0, std::min(to, pixel + 1.0) - std::max(from, double(pixel)));
  };
  for (int y = static_cast<int>(top); y < std::min(bottom, double(ink.rows)); ++y)
    for (int x = static_cast<int>(left); x < std::min(right, double(ink.cols)); ++x)
      ink.at<float>(y, x) += static_cast<float>(covered(top, bottom, y) * covered(left, right, x));
}

void write_words(cv::Mat& gray, const PageText& text) {
  constexpr int kFace = cv::FONT_HERSHEY_SIMPLEX;
  constexpr double kHeightAt1_px = 30;  // of this font, as others measure it
  double scale = text.size_mm * kPixelsPerMm / kHeightAt1_px;
  const double wide = cv::getTextSize(text.words, kFace, scale, 2, nullptr).width;
  const double room = gray.cols - 2 * text.x_mm * kPixelsPerMm;
  if (wide > room && text.x_mm * 2 * kPixelsPerMm < gray.cols) scale *= room / wide;
  cv::putText(gray, text.words, {static_cast<int>(text.x_mm * kPixelsPerMm), static_cast<int>(text.y_mm * kPixelsPerMm)}, kFace,
              scale, {0}, 2, cv::LINE_AA);
}

void append_big_endian(std::string& to, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) to += static_cast<char>(value >> shift & 0xFF);
}

/// A PNG with its pixels a metre instead of their shape.
std::string with_scale(const std::string& png) {
  constexpr std::size_t kHeader = 8 + 25, kScale = 21;  // signature and IHDR, then pHYs
  std::string chunk = "pHYs";
  append_big_endian(chunk, 1000 * kPixelsPerMm);
  append_big_endian(chunk, 1000 * kPixelsPerMm);
  chunk += '\1';  // the unit is the metre
  const std::uint32_t crc =
      ~av_crc(av_crc_get_table(AV_CRC_32_IEEE_LE), ~0u, reinterpret_cast<const std::uint8_t*>(chunk.data()), chunk.size());
  std::string length;
  append_big_endian(length, static_cast<std::uint32_t>(chunk.size() - 4));
  append_big_endian(chunk, crc);
  return png.substr(0, kHeader) + length + chunk + png.substr(kHeader + kScale);
}

}  // namespace

std::string svg_of(const BoardPage& page) {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.6g}mm\" height=\"{1:.6g}mm\" viewBox=\"0 0 {0:.6g} {1:.6g}\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<path d=\"",
      page.width_mm, page.height_mm);
  for (const PageRect& r : page.black)
    out += fmt::format("M{:.6g} {:.6g}h{:.6g}v{:.6g}h{:.6g}z\n", r.x_mm, r.y_mm, r.width_mm, r.height_mm, -r.width_mm);
  out += "\"/>\n";
  for (const PageText& t : page.texts)
    out += fmt::format(
        "<text x=\"{:.6g}\" y=\"{:.6g}\" font-size=\"{:.6g}\" font-family=\"Helvetica, Arial, sans-serif\">{}</text>\n", t.x_mm,
        t.y_mm, t.size_mm, escaped_xml(t.words));
  return out + "</svg>\n";
}

std::string pdf_of(const BoardPage& page) {
  constexpr double kPoint_mm = 25.4 / 72;
  // From here on millimetres, y down.
  std::string content =
      fmt::format("{0:.9g} 0 0 {1:.9g} 0 {2:.9g} cm\n", 1 / kPoint_mm, -1 / kPoint_mm, page.height_mm / kPoint_mm);
  for (const PageRect& r : page.black)
    content += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} re\n", r.x_mm, r.y_mm, r.width_mm, r.height_mm);
  content += "f\n";
  for (const PageText& t : page.texts)
    content += fmt::format("BT /F1 1 Tf {0:.6g} 0 0 {1:.6g} {2:.6g} {3:.6g} Tm ({4}) Tj ET\n", t.size_mm, -t.size_mm, t.x_mm,
                           t.y_mm, escaped_pdf(t.words));
  const std::string objects[] = {
      "<</Type/Catalog/Pages 2 0 R/ViewerPreferences<</PrintScaling/None>>>>",  // print dialogs then offer true size first
      "<</Type/Pages/Kids[3 0 R]/Count 1>>",
      fmt::format("<</Type/Page/Parent 2 0 R/MediaBox[0 0 {:.9g} {:.9g}]/Contents 4 0 R/Resources<</Font<</F1 5 0 R>>>>>>",
                  page.width_mm / kPoint_mm, page.height_mm / kPoint_mm),
      fmt::format("<</Length {}>>\nstream\n{}endstream", content.size(), content),
      "<</Type/Font/Subtype/Type1/BaseFont/Helvetica>>"};
  std::string out = "%PDF-1.6\n", table = "0000000000 65535 f \n";
  int number = 0;
  for (const std::string& object : objects) {
    table += fmt::format("{:010} 00000 n \n", out.size());
    out += fmt::format("{} 0 obj\n{}\nendobj\n", ++number, object);
  }
  const std::size_t table_at = out.size();
  return out +
         fmt::format("xref\n0 {0}\n{1}trailer\n<</Size {0}/Root 1 0 R>>\nstartxref\n{2}\n%%EOF\n", number + 1, table, table_at);
}

std::string png_page(const BoardPage& page) {
  const cv::Size size(static_cast<int>(std::lround(page.width_mm * kPixelsPerMm)),
                      static_cast<int>(std::lround(page.height_mm * kPixelsPerMm)));
  cv::Mat ink = cv::Mat::zeros(size, CV_32F), gray;
  for (const PageRect& rect : page.black) fill(ink, rect);
  ink.convertTo(gray, CV_8U, -255, 255);
  for (const PageText& text : page.texts) write_words(gray, text);
  const View<const std::uint8_t> pixels(gray.ptr(), {gray.cols, gray.rows}, static_cast<std::ptrdiff_t>(gray.step));
  const std::string png = png_of(pixels);
  return png.empty() ? png : with_scale(png);
}

Result<void> write_board(const Board& board, const Paper& paper, const std::filesystem::path& path) {
  DUO_TRY_ASSIGN(const BoardPage page, lay_out_board(board, paper));
  const std::string ending = path.extension().string();
  if (ending == ".pdf" || is_stdout(path)) return write_file(path, pdf_of(page));
  if (ending == ".svg") return write_file(path, svg_of(page));
  if (ending == ".png") {
    const std::string png = png_page(page);
    if (png.empty())
      return Error{ErrorCode::kWriteFailed,
                   fmt::format("cannot write '{}': the page cannot be encoded as PNG; give a name that ends with .pdf or .svg",
                               path.string())};
    return write_file(path, png);
  }
  return Error{ErrorCode::kBadInput,
               fmt::format("cannot write a board to '{}': give a name that ends with .pdf, .svg or .png", path.string())};
}

}  // namespace duo
