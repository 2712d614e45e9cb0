#include "server/lru_cache.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace marrow {
namespace {

std::shared_ptr<const std::string> Value(const char* text) {
  return std::make_shared<const std::string>(text);
}

TEST(LruCacheTest, KeepsWithinTheBudgetWhatWasUsedLast) {
  LruCache<int, std::string> cache(10);
  cache.Insert(1, Value("one"), 4);
  cache.Insert(2, Value("two"), 4);
  EXPECT_EQ(*cache.Find(1), "one");
  cache.Insert(3, Value("three"), 6);
  EXPECT_EQ(cache.bytes(), 10u);
  EXPECT_TRUE(cache.Contains(1));
  EXPECT_FALSE(cache.Contains(2));
  EXPECT_EQ(*cache.Find(3), "three");
}

TEST(LruCacheTest, ContainsDoesNotCountAsUse) {
  LruCache<int, std::string> cache(8);
  cache.Insert(1, Value("one"), 4);
  cache.Insert(2, Value("two"), 4);
  EXPECT_TRUE(cache.Contains(1));
  cache.Insert(3, Value("three"), 4);
  EXPECT_FALSE(cache.Contains(1));
}

TEST(LruCacheTest, ReplacesAnEntryAndItsBytes) {
  LruCache<int, std::string> cache(10);
  cache.Insert(1, Value("one"), 4);
  cache.Insert(1, Value("uno"), 7);
  EXPECT_EQ(*cache.Find(1), "uno");
  EXPECT_EQ(cache.bytes(), 7u);
}

TEST(LruCacheTest, WhatExceedsTheBudgetDropsNothing) {
  LruCache<int, std::string> cache(10);
  cache.Insert(1, Value("one"), 10);
  cache.Insert(2, Value("two"), 11);
  EXPECT_TRUE(cache.Contains(1));
  EXPECT_EQ(cache.Find(2), nullptr);
}

}  // namespace
}  // namespace marrow
