// SPDX-License-Identifier: Apache-2.0
#include "instruction.h"

#include <algorithm>
#include <initializer_list>

namespace boresight::cycles {
namespace {

std::uint8_t registerIf(bool used, int number) {
  return static_cast<std::uint8_t>(used ? number : kNone);
}

bool isOneOf(int opcode, std::initializer_list<int> opcodes) {
  return std::find(opcodes.begin(), opcodes.end(), opcode) != opcodes.end();
}

/// Fields of a word, by the names of the architecture.
struct Fields {
  std::uint32_t word;

  int bits(int first, int count) const {
    return static_cast<int>(word >> (32 - first - count) & ((1U << count) - 1));
  }
  std::uint8_t d() const { return static_cast<std::uint8_t>(bits(6, 5)); }
  std::uint8_t a() const { return static_cast<std::uint8_t>(bits(11, 5)); }
  std::uint8_t b() const { return static_cast<std::uint8_t>(bits(16, 5)); }
  std::uint8_t aOrZero() const { return registerIf(a() != 0, a()); }
  std::uint8_t floatRegister(int first) const {
    return static_cast<std::uint8_t>(kFirstFloat + bits(first, 5));
  }
  std::uint8_t conditionField(int first) const {
    return static_cast<std::uint8_t>(kFirstCondition + bits(first, 3));
  }
  bool record() const { return (word & 1) != 0; }
};

void setTiming(Instruction& instruction, Unit unit, Kind kind, int latency, int occupancy) {
  instruction.unit = unit;
  instruction.kind = kind;
  instruction.latency = static_cast<std::uint8_t>(latency);
  instruction.occupancy = static_cast<std::uint8_t>(occupancy);
}

void decodeBranch(const Fields& fields, Instruction& instruction) {
  const int opcode = fields.bits(0, 6);
  setTiming(instruction, Unit::kBranch, Kind::kBranch, 1, 1);
  instruction.links = fields.record();
  if (instruction.links) instruction.targets[0] = kLink;
  if (opcode == 18) return;
  instruction.counts = (fields.d() & 4) == 0;
  instruction.conditional = (fields.d() & 16) == 0;
  if (instruction.counts) instruction.targets[1] = kCount;
  if (instruction.counts) instruction.sources[2] = kCount;
  if (instruction.conditional) instruction.sources[0] = fields.conditionField(11);
  instruction.indirect = opcode == 19;
  const bool by_link = fields.bits(21, 10) == 16;
  instruction.sources[1] = registerIf(instruction.indirect, by_link ? kLink : kCount);
}

/// Opcode 19: branches to registers, logic of conditions, isync.
void decodeConditionLogic(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  if (extended == 16 || extended == 528) return decodeBranch(fields, instruction);
  setTiming(instruction, Unit::kSystem, Kind::kSystem, 1, 1);
  instruction.serialized = true;
  if (extended == 150) return;  // isync
  instruction.sources = {fields.conditionField(11), fields.conditionField(16),
                         fields.conditionField(6), kNone};
  instruction.targets[0] = fields.conditionField(6);
}

/// Loads and stores; `indexed`: address of two registers.
void decodeMemory(const Fields& fields, bool is_float, bool store, bool update, bool indexed,
                  Instruction& instruction) {
  setTiming(instruction, Unit::kLoadStore, store ? Kind::kStore : Kind::kLoad, 2, 1);
  const std::uint8_t data = is_float ? fields.floatRegister(6) : fields.d();
  instruction.memory = true;
  instruction.store = store;
  instruction.sources = {fields.aOrZero(), registerIf(indexed, fields.b()), registerIf(store, data),
                         kNone};
  if (!store) instruction.targets[0] = data;
  if (update) instruction.targets[1] = fields.a();
}

/// Opcodes 32 to 55: address of a register and a displacement.
void decodeDisplacement(const Fields& fields, Instruction& instruction) {
  const int opcode = fields.bits(0, 6);
  const bool multiple = opcode == 46 || opcode == 47;
  const bool store = (opcode >= 36 && opcode <= 39) || opcode == 44 || opcode == 45 ||
                     opcode == 47 || opcode >= 52;
  decodeMemory(fields, opcode >= 48, store, !multiple && opcode % 2 == 1, false, instruction);
  if (!multiple) return;
  const int registers = 32 - fields.d();
  instruction.latency = static_cast<std::uint8_t>(2 + registers);
  instruction.occupancy = instruction.latency;
  instruction.serialized = true;
}

/// Opcode 31, addition to division: extended opcodes of 9 bits. False: another instruction.
bool decodeArithmetic(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(22, 9);
  const bool multiplies = isOneOf(extended, {235, 75, 11});
  const bool divides = isOneOf(extended, {491, 459});
  const bool uses_carry = isOneOf(extended, {138, 136, 202, 200, 234, 232});
  const bool writes_carry = uses_carry || isOneOf(extended, {10, 8});
  if (!multiplies && !divides && !writes_carry && !isOneOf(extended, {266, 40, 104})) return false;
  if (multiplies) setTiming(instruction, Unit::kFirstInteger, Kind::kMultiply, 5, 5);
  if (divides) setTiming(instruction, Unit::kFirstInteger, Kind::kDivide, 19, 19);
  instruction.uses_carry = uses_carry;
  instruction.sources = {fields.a(), fields.b(), kNone, registerIf(uses_carry, kCarry)};
  instruction.targets = {fields.d(), registerIf(writes_carry, kCarry),
                         registerIf(fields.record(), kFirstCondition)};
  return true;
}

/// Opcode 31, loads and stores with an index. False: another instruction.
bool decodeIndexed(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  const bool store =
      isOneOf(extended, {150, 151, 183, 215, 247, 407, 439, 662, 663, 695, 727, 759, 918, 983});
  if (!store &&
      !isOneOf(extended, {20, 23, 55, 87, 119, 279, 311, 343, 375, 534, 535, 567, 599, 631, 790}))
    return false;
  const bool is_float =
      extended == 983 || (extended >= 535 && extended <= 759 && extended % 32 == 23);
  const bool update = extended % 64 == 55 && extended != 983;
  decodeMemory(fields, is_float, store, update, true, instruction);
  if (extended == 20 || extended == 150) instruction.serialized = true;
  if (extended == 150) instruction.targets[2] = kFirstCondition;
  return true;
}

/// Opcode 31, moves of special registers and hints for caches. False: another instruction.
bool decodeSpecial(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  if (!isOneOf(extended, {19, 54, 86, 144, 246, 278, 339, 371, 467, 470, 512, 598, 854, 982, 1014}))
    return false;
  const int special = fields.a();  // the low half of the register's number comes first
  if (extended == 339 || extended == 467) {
    const bool reads = extended == 339;
    const auto named = static_cast<std::uint8_t>(special == 8   ? kLink
                                                 : special == 9 ? kCount
                                                                : kCarry);
    setTiming(instruction, Unit::kSystem, Kind::kSystem, reads ? 1 : 2, reads ? 1 : 2);
    instruction.serialized = special == 1;
    instruction.sources[0] = reads ? named : fields.d();
    instruction.targets[0] = reads ? fields.d() : named;
    return true;
  }
  instruction.serialized = true;
  if (isOneOf(extended, {19, 144, 371, 512})) {
    setTiming(instruction, Unit::kSystem, Kind::kSystem, 1, 1);
    instruction.targets[0] = extended == 144 ? std::uint8_t{kFirstCondition} : fields.d();
    return true;
  }
  setTiming(instruction, Unit::kLoadStore, Kind::kStore, 3, 6);
  return true;
}

/// Opcode 31.
void decodeExtended(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  if (extended == 0 || extended == 32) {
    instruction.sources = {fields.a(), fields.b(), kNone, kNone};
    instruction.targets[0] = fields.conditionField(6);
    return;
  }
  if (decodeIndexed(fields, instruction) || decodeSpecial(fields, instruction) ||
      decodeArithmetic(fields, instruction))
    return;
  // Logic, shifts, signs, leading zeros: from D and B to A.
  const bool one_source = isOneOf(extended, {26, 824, 922, 954});
  instruction.sources = {fields.d(), registerIf(!one_source, fields.b()), kNone, kNone};
  instruction.targets = {fields.a(), registerIf(isOneOf(extended, {792, 824}), kCarry),
                         registerIf(fields.record(), kFirstCondition)};
}

/// Opcodes 59 and 63 with three operands. False: another instruction.
bool decodeFloatArithmetic(const Fields& fields, Instruction& instruction) {
  const bool single = fields.bits(0, 6) == 59;
  const int extended = fields.bits(26, 5);
  const bool multiplies = extended == 25 || extended >= 28;
  if (extended == 18)
    setTiming(instruction, Unit::kFloat, Kind::kFloatDivide, single ? 17 : 31, single ? 17 : 31);
  else if (extended == 20 || extended == 21)
    setTiming(instruction, Unit::kFloat, Kind::kFloatAdd, 3, 1);
  else if (multiplies)
    setTiming(instruction, Unit::kFloat, Kind::kFloatMultiply, single ? 3 : 4, single ? 1 : 2);
  else if (extended == 24)
    setTiming(instruction, Unit::kFloat, Kind::kFloatOther, 10, 10);
  else if (extended == 23 || extended == 26)
    setTiming(instruction, Unit::kFloat, Kind::kFloatOther, 3, 1);
  else
    return false;
  const bool uses_a = extended != 24 && extended != 26;
  const bool uses_c = extended == 23 || multiplies;
  instruction.sources = {registerIf(uses_a, fields.floatRegister(11)),
                         registerIf(extended != 25, fields.floatRegister(16)),
                         registerIf(uses_c, fields.floatRegister(21)), kNone};
  instruction.targets[0] = fields.floatRegister(6);
  return true;
}

void decodeFloat(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  const bool compares = extended == 0 || extended == 32;
  const bool status = isOneOf(extended, {38, 64, 70, 134, 583, 711});
  if (!compares && !status && decodeFloatArithmetic(fields, instruction)) return;
  setTiming(instruction, Unit::kFloat, Kind::kFloatOther, 3, 1);
  instruction.serialized = status;
  instruction.sources = {registerIf(compares, fields.floatRegister(11)), fields.floatRegister(16),
                         kNone, kNone};
  instruction.targets[0] = compares ? fields.conditionField(6) : fields.floatRegister(6);
}

/// Integer instructions with an immediate operand, rotations among them.
void decodeImmediate(const Fields& fields, Instruction& instruction) {
  const int opcode = fields.bits(0, 6);
  const bool logic = opcode >= 20;
  instruction.sources[0] = logic ? fields.d() : fields.a();
  instruction.targets[0] = logic ? fields.a() : fields.d();
  if (opcode == 14 || opcode == 15) instruction.sources[0] = fields.aOrZero();
  if (opcode == 20) instruction.sources[1] = fields.a();
  if (opcode == 23) instruction.sources[1] = fields.b();
  if (opcode == 7) setTiming(instruction, Unit::kFirstInteger, Kind::kMultiply, 3, 3);
  if (opcode == 8 || opcode == 12 || opcode == 13) instruction.targets[1] = kCarry;
  if (opcode == 10 || opcode == 11) instruction.targets[0] = fields.conditionField(6);
  const bool rotation = opcode >= 20 && opcode <= 23;
  if (opcode == 13 || opcode == 28 || opcode == 29 || (rotation && fields.record()))
    instruction.targets[2] = kFirstCondition;
}

}  // namespace

Instruction decode(std::uint32_t word) {
  const Fields fields{word};
  Instruction instruction;
  instruction.word = word;
  const int opcode = fields.bits(0, 6);
  if (opcode == 16 || opcode == 18) {
    decodeBranch(fields, instruction);
  } else if (opcode == 19) {
    decodeConditionLogic(fields, instruction);
  } else if (opcode == 31) {
    decodeExtended(fields, instruction);
  } else if (opcode >= 32 && opcode <= 55) {
    decodeDisplacement(fields, instruction);
  } else if (opcode == 59 || opcode == 63) {
    decodeFloat(fields, instruction);
  } else if (opcode == 17) {
    setTiming(instruction, Unit::kSystem, Kind::kSystem, 2, 2);
    instruction.serialized = true;
  } else {
    decodeImmediate(fields, instruction);
  }
  return instruction;
}

}  // namespace boresight::cycles
