// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/sqlite.h"

#include <sqlite3.h>

#include <string_view>
#include <utility>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"

namespace boresight::sessions {
namespace {

constexpr int kPatience_ms = 10'000;

int flagsOf(SqlAccess access) {
  // Reading, too, must be able to take back what a killed writer had not committed; where the file
  // cannot be written SQLite opens it for reading by itself.
  return access == SqlAccess::kRead ? SQLITE_OPEN_READWRITE
                                    : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
}

/// What a file from outside brings along is data: it runs nothing and reaches no other file.
void distrust(sqlite3* handle) {
  for (const auto& [setting, value] :
       {std::pair(SQLITE_DBCONFIG_DEFENSIVE, 1), std::pair(SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0),
        std::pair(SQLITE_DBCONFIG_ENABLE_TRIGGER, 0), std::pair(SQLITE_DBCONFIG_ENABLE_VIEW, 0)})
    sqlite3_db_config(handle, setting, value, nullptr);
}

/// A path in a URI: all but letters, digits and a few signs as %XX.
std::string uriPath(const std::string& path) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789/._-";
  std::string text;
  for (const char letter : path) {
    if (kPlain.find(letter) != std::string_view::npos) {
      text += letter;
      continue;
    }
    const auto byte = static_cast<unsigned char>(letter);
    text += '%';
    text += kDigits[byte / 16];
    text += kDigits[byte % 16];
  }
  return text;
}

}  // namespace

SqlValue sqlFlag(bool value) { return std::int64_t{value ? 1 : 0}; }

SqlValue sqlFlag(const std::optional<bool>& value) { return value ? sqlFlag(*value) : SqlValue(); }

SqlValue sqlReal(const std::optional<double>& value) {
  return value ? SqlValue(*value) : SqlValue();
}

std::optional<double> realOf(const SqlValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  return std::nullopt;
}

std::int64_t integerOf(const SqlValue& value) {
  const auto* integer = std::get_if<std::int64_t>(&value);
  return integer != nullptr ? *integer : 0;
}

std::string textOf(const SqlValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr ? *text : std::string();
}

SqlDatabase::SqlDatabase(const std::filesystem::path& file, SqlAccess access)
    : file_(file), access_(access) {
  std::error_code error;
  if (access == SqlAccess::kRead && !std::filesystem::exists(file, error))
    throw InputError(file, "there is no such file");
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    fail("it is a folder, a pipe or a device, not a file");
  if (access == SqlAccess::kRead) noteInput(file, FileUse::kResults);
  // Of a relative name SQLite takes "file:..." for an address and ":memory:" for no file.
  const std::filesystem::path whole =
      file.empty() ? std::filesystem::path(":memory:") : std::filesystem::absolute(file, error);
  open(whole.string(), flagsOf(access));
  if (access == SqlAccess::kWrite) return;
  execute("PRAGMA query_only = 1");
  const int first_read =
      sqlite3_exec(handle(), "SELECT count(*) FROM sqlite_master", nullptr, nullptr, nullptr) &
      0xFF;
  if (first_read == SQLITE_READONLY || first_read == SQLITE_CANTOPEN) openAsItIs();
}

void SqlDatabase::open(const std::string& name, int flags) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &handle, flags, nullptr);
  handle_.reset(handle);
  if (code != SQLITE_OK && handle == nullptr) throw std::bad_alloc();
  require(code);
  distrust(handle);
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, kPatience_ms);
}

/// For a file that SQLite cannot read without writing next to it. Only a file that is complete by
/// itself is read so: changes in a log would be missed, or half of them taken for the whole.
void SqlDatabase::openAsItIs() {
  for (const char* end : {"-wal", "-journal"}) {
    std::error_code error;
    std::filesystem::path log = file_;
    log += end;
    if (std::filesystem::file_size(log, error) > 0 && !error)
      fail("its last changes are still in " + log.filename().string() +
           ", and its folder cannot be written: copy both files to a folder that can");
  }
  open("file:" + uriPath(std::filesystem::absolute(file_).string()) + "?immutable=1",
       SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
}

SqlDatabase::SqlDatabase(SqlDatabase&&) noexcept = default;
SqlDatabase& SqlDatabase::operator=(SqlDatabase&&) noexcept = default;
SqlDatabase::~SqlDatabase() = default;

void SqlDatabase::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

void SqlDatabase::require(int code) const {
  if (code == SQLITE_OK || code == SQLITE_DONE || code == SQLITE_ROW) return;
  switch (code & 0xFF) {
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    case SQLITE_NOTADB:
      fail("it is not a results file (not an SQLite database)");
    case SQLITE_BUSY:
      fail("another program has locked it");
    case SQLITE_FULL:
      fail("no space left on the device");
    default:
      fail(sqlite3_errmsg(handle_.get()));
  }
}

void SqlDatabase::fail(const std::string& reason) const {
  if (access_ == SqlAccess::kRead) throw InputError(file_, reason);
  throw OutputError(file_, reason);
}

void SqlDatabase::execute(const std::string& sql) {
  require(sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

void SqlDatabase::run(const std::string& sql, const std::vector<SqlValue>& values) {
  SqlStatement(*this, sql).run(values);
}

SqlValue SqlDatabase::value(const std::string& sql, const std::vector<SqlValue>& values) const {
  SqlStatement statement(*this, sql);
  statement.bind(values);
  return statement.step() ? statement.cell(0) : SqlValue();
}

std::vector<std::string> SqlDatabase::columns(const std::string& table) {
  SqlStatement statement(*this, "SELECT name FROM pragma_table_info(?1) ORDER BY cid");
  statement.bind({table});
  std::vector<std::string> names;
  while (statement.step()) names.push_back(textOf(statement.cell(0)));
  return names;
}

std::int64_t SqlDatabase::lastId() const { return sqlite3_last_insert_rowid(handle_.get()); }

SqlStatement::SqlStatement(const SqlDatabase& database, const std::string& sql)
    : database_(&database) {
  sqlite3_stmt* statement = nullptr;
  database.require(sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &statement, nullptr));
  statement_.reset(statement);
}

void SqlStatement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void SqlStatement::bind(const std::vector<SqlValue>& values) {
  sqlite3_reset(statement_.get());  // repeats the error of the last step, which was reported then
  int index = 0;
  for (const SqlValue& value : values) {
    ++index;
    int code = SQLITE_OK;
    if (const auto* integer = std::get_if<std::int64_t>(&value)) {
      code = sqlite3_bind_int64(statement_.get(), index, *integer);
    } else if (const auto* real = std::get_if<double>(&value)) {
      code = sqlite3_bind_double(statement_.get(), index, *real);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
      code = sqlite3_bind_text(statement_.get(), index, text->c_str(),
                               static_cast<int>(text->size()), SQLITE_TRANSIENT);
    } else {
      code = sqlite3_bind_null(statement_.get(), index);
    }
    database_->require(code);
  }
}

bool SqlStatement::step() {
  const int code = sqlite3_step(statement_.get());
  database_->require(code);
  return code == SQLITE_ROW;
}

void SqlStatement::run(const std::vector<SqlValue>& values) {
  bind(values);
  (void)step();
  sqlite3_reset(statement_.get());
}

SqlValue SqlStatement::cell(int column) const {
  sqlite3_stmt* statement = statement_.get();
  switch (sqlite3_column_type(statement, column)) {
    case SQLITE_INTEGER:
      return std::int64_t{sqlite3_column_int64(statement, column)};
    case SQLITE_FLOAT:
      return sqlite3_column_double(statement, column);
    case SQLITE_TEXT:
    case SQLITE_BLOB: {
      const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, column));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, column));
      return bytes != nullptr ? std::string(bytes, size) : std::string();
    }
    default:
      return {};
  }
}

std::vector<SqlValue> SqlStatement::row() const {
  std::vector<SqlValue> cells;
  for (int i = 0; i < sqlite3_column_count(statement_.get()); ++i) cells.push_back(cell(i));
  return cells;
}

SqlTransaction::SqlTransaction(SqlDatabase& database) : database_(&database) {
  database.execute("BEGIN IMMEDIATE");
}

SqlTransaction::~SqlTransaction() {
  if (database_ != nullptr)
    sqlite3_exec(database_->handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void SqlTransaction::commit() {
  database_->execute("COMMIT");
  database_ = nullptr;
}

}  // namespace boresight::sessions
