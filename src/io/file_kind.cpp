// Recognises the kind of a file.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "io/containers.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kReadable =
    "Supported are PLY, PCD, XYZ/TXT/CSV, PTX, OBJ, STL, glTF, GLB, LAS, LAZ, E57, NPY, KITTI's "
    ".bin, "
    "SPZ, .splat, 16-bit depth PNG and PGM, optionally gzipped";

struct Signature {
  std::string_view start;
  FileKind kind;
};

constexpr Signature kSignatures[] = {
    {"ply\n", FileKind::ply},  {"ply\r", FileKind::ply},    {"ply ", FileKind::ply},
    {"LASF", FileKind::las},   {"ASTM-E57", FileKind::e57}, {"\x89PNG\r\n\x1a\n", FileKind::png},
    {"P5", FileKind::pgm},     {"NGSP", FileKind::spz},     {"\x1f\x8b", FileKind::gz},
    {"# .PCD", FileKind::pcd}, {"glTF", FileKind::gltf},    {"\x93NUMPY", FileKind::npy},
};

struct Refused {
  std::string_view start;
  std::string_view what;
  std::string_view remedy;  // {}: the file's name
};

constexpr std::string_view kExport =
    "Export the points as PLY, for example with CloudCompare or MeshLab";

constexpr Refused kRefused[] = {
    {"\xfd"
     "7zXZ\0"sv,
     "compressed with xz",
     "Unpack it first: \"xz -dk FILE\", or pipe it: \"xz -dc FILE | palpate ... -\""},
    {"(\xb5/\xfd", "compressed with zstd", "Unpack it first: zstd -d FILE"},
    {"BZh", "compressed with bzip2", "Unpack it first: bunzip2 -k FILE"},
    {"PK\x03\x04", "a ZIP archive", "Unpack it first and give the cloud inside: unzip FILE"},
    {"\xff\xd8\xff", "a JPEG picture", kReadable},
    {"GIF8", "a GIF picture", kReadable},
    {"BM", "a BMP picture", kReadable},
    {"II*\0"sv, "a TIFF picture", "Convert depth images to 16-bit grey PNG"},
    {"MM\0*"sv, "a TIFF picture", "Convert depth images to 16-bit grey PNG"},
    {"P6", "a colour picture (PPM)", "Give the 16-bit depth image of the camera"},
    {"Pf\n", "a picture of floats (PFM)",
     "Make a 16-bit PGM of millimetres of it: python3 -c \"import numpy as np; "
     "f = open('IN.pfm', 'rb'); f.readline(); w, h = f.readline().split(); "
     "t = '<f4' if float(f.readline()) < 0 else '>f4'; "
     "a = 1000 * np.frombuffer(f.read(), t).reshape(int(h), -1)[::-1]; "
     "a = np.nan_to_num(a, posinf=0).clip(0, 65534).round().astype('>u2'); "
     "open('OUT.pgm', 'wb').write(b'P5 %d %d 65535\\n' % a.shape[::-1] + a.tobytes())\""},
    {"P2", "a PGM written as text", "Convert it to binary PGM (P5) or to 16-bit PNG"},
    {"\x89HDF", "an HDF5 file", "Export the points as PLY or text"},
    {"OFF", "an OFF model", kExport},
    {"Kaydara FBX", "an FBX model", kExport},
    {"#ROSBAG", "a ROS bag", "Export one cloud from it as PCD"},
    {"\x89MCAP", "an MCAP recording",
     "Touch what a camera recorded: palpate touch bag:{0}; see a recorded run: palpate replay {0} "
     "--view"},
    {"%PDF", "a PDF document", kReadable},
    {"\x7f"
     "ELF",
     "a program", kReadable},
    {"<", "a web page or XML document", "If it was downloaded, download the file itself again"},
    {"{", "a JSON document", kReadable},
    {"[", "a JSON document", kReadable},
    {"version https://git-lfs", "a Git LFS pointer, not the file itself",
     "Download the file: git lfs pull"},
};

// Text if the first few thousand bytes hold no control characters but white space.
bool looks_like_text(std::string_view text) {
  const std::string_view head = text.substr(0, 4096);
  return std::all_of(head.begin(), head.end(),
                     [](char c) { return c < 0 || c >= ' ' || (c >= '\t' && c <= '\r'); });
}

// The first word of text that is no comment.
std::string_view first_word(const Input& input) {
  TextScanner scanner(input);
  while (!scanner.at_end()) {
    std::string_view line = scanner.next_line();
    if (!is_blank_or_comment(line)) return take_word(line);
  }
  return {};
}

// JSON that is named as glTF, or whose first words show it.
bool is_gltf_json(const Input& input) {
  constexpr std::size_t kFirst = 4096;  // bytes in which "asset" is looked for (judgement)
  const std::string_view head = input.text().substr(0, kFirst);
  if (!trim(head).starts_with('{')) return false;
  return extension(input.name) == ".gltf" || head.find("\"asset\"") != std::string_view::npos;
}

FileKind text_kind(const Input& input, std::string_view word) {
  constexpr std::string_view kObjWords[] = {"v", "vn", "vt", "mtllib", "o", "g", "s", "usemtl"};
  const bool is_obj =
      std::find(std::begin(kObjWords), std::end(kObjWords), word) != std::end(kObjWords);
  if (is_obj || extension(input.name) == ".obj") return FileKind::obj;
  return is_ptx(input) ? FileKind::ptx : FileKind::xyz;
}

void refuse_unsupported(const Input& input) {
  if (is_utf16(input.text())) fail(input, "this is UTF-16 text", "Save it as UTF-8");
  if (extension(input.name) == ".toml") {
    fail(input, "this is a set-up file, not a point cloud",
         fmt::format("Give it as one: palpate touch --setup {}", input.name));
  }
  for (const Refused& entry : kRefused) {
    if (input.text().starts_with(entry.start)) {
      fail(input, fmt::format("this is {}, not a supported point cloud", entry.what),
           fmt::format(fmt::runtime(entry.remedy), input.name));
    }
  }
}

// Formats of splats that are not read, which may begin like anything.
void refuse_splats(const Input& input) {
  const std::string ending = extension(input.name);
  if (ending != ".sog" && ending != ".ksplat" && ending != ".lcc") return;
  fail(input, fmt::format("splats as {} are not read", ending),
       fmt::format("Convert them: npx @playcanvas/splat-transform {} splats.ply", input.name));
}

[[noreturn]] void refuse_unknown(const Input& input) {
  std::string head;
  for (const std::byte b : input.bytes.first(std::min<std::size_t>(input.bytes.size(), 8))) {
    head += fmt::format(" {:02x}", std::to_integer<unsigned>(b));
  }
  fail(input, fmt::format("unknown file type (it starts with{})", head), kReadable);
}

}  // namespace

FileKind kind_of(const Input& input) {
  if (input.bytes.empty()) {
    fail(input, "the file is empty", "Download or export it again");
  }
  refuse_splats(input);
  const std::string ending = extension(input.name);
  if (ending == ".splat") return FileKind::splat;
  if (lower_case(input.name).ends_with("points3d.bin")) {
    fail(input, "this is COLMAP's list of points in bytes",
         "Make text of it, and give its points3D.txt: colmap model_converter --input_path FOLDER "
         "--output_path FOLDER --output_type TXT");
  }
  if (ending == ".bin" && !looks_like_text(input.text())) return FileKind::npy;
  for (const Signature& entry : kSignatures) {
    if (input.text().starts_with(entry.start)) return entry.kind;
  }
  if (is_stl(input)) return FileKind::stl;
  refuse_containers(input);
  if (is_gltf_json(input)) return FileKind::gltf;
  refuse_unsupported(input);
  // The comment that begins a PCD may be missing, and its points may be no text.
  const std::string_view word = first_word(input);
  if (word == "VERSION" || word == "FIELDS" || word == "COLUMNS") return FileKind::pcd;
  if (!looks_like_text(input.text())) refuse_unknown(input);
  return text_kind(input, word);
}

}  // namespace palpate::io
