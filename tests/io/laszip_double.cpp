// Stands in for LASzip in the tests: the functions of its C interface that we call, over a file
// whose records are not compressed at all. Fills laszip_point_struct as LASzip 3 lays it out.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace {

struct Reader {
  std::FILE* file = nullptr;
  int format = 0;
  std::array<unsigned char, 96> point{};
  std::array<unsigned char, 256> record{};
  std::size_t record_size = 0;
  char error[32] = "the double's own words";
};

Reader* reader_of(void* handle) {
  return static_cast<Reader*>(handle);
}

}  // namespace

extern "C" {

int laszip_create(void** handle) {
  *handle = new Reader;
  return 0;
}

int laszip_destroy(void* handle) {
  delete reader_of(handle);
  return 0;
}

int laszip_open_reader(void* handle, const char* name, int* is_compressed) {
  Reader* reader = reader_of(handle);
  reader->file = std::fopen(name, "rb");
  if (reader->file == nullptr) return 1;
  std::array<unsigned char, 227> header{};
  if (std::fread(header.data(), 1, header.size(), reader->file) != header.size()) return 1;
  std::uint32_t offset = 0;
  std::uint16_t size = 0;
  std::memcpy(&offset, header.data() + 96, sizeof offset);
  std::memcpy(&size, header.data() + 105, sizeof size);
  reader->format = header[104] & 63;
  reader->record_size = size;
  *is_compressed = 1;
  return std::fseek(reader->file, static_cast<long>(offset), SEEK_SET);
}

int laszip_close_reader(void* handle) {
  return std::fclose(reader_of(handle)->file);
}

int laszip_get_point_pointer(void* handle, std::byte** point) {
  *point = reinterpret_cast<std::byte*>(reader_of(handle)->point.data());
  return 0;
}

int laszip_read_point(void* handle) {
  Reader* reader = reader_of(handle);
  auto& record = reader->record;
  auto& point = reader->point;
  if (std::fread(record.data(), 1, reader->record_size, reader->file) != reader->record_size) {
    return 1;
  }
  std::memcpy(point.data(), record.data(), 20);
  if (reader->format >= 6) {
    point[15] = 0;
    point[22] = static_cast<unsigned char>((record[15] & 15) << 4);
    std::memcpy(point.data() + 40, record.data() + 30, 6);
  } else {
    std::memcpy(point.data() + 40, record.data() + (reader->format == 2 ? 20 : 28), 6);
  }
  return 0;
}

int laszip_get_error(void* handle, char** message) {
  *message = reader_of(handle)->error;
  return 0;
}
}
