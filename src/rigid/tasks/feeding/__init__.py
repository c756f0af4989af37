"""Feeding: a robot arm brings a spoon of food to the mouth of a person who moves the head."""
