"""Modules for TorchScript, which reads their source."""

import torch


class Follower(torch.nn.Module):
    """Goes to the hand."""

    def forward(self, seen: torch.Tensor):
        return seen[:, 1:] - seen[:, :1]


class Adding(torch.nn.Module):
    """Adds up the first number."""

    @torch.jit.export
    def initial_state(self, batch: int):
        return torch.zeros(batch, 1)

    def forward(self, seen: torch.Tensor, total: torch.Tensor):
        total = total + seen[:, :1]
        return total, total


class Hiding(torch.nn.Module):
    """Remembers inside."""

    def __init__(self):
        super().__init__()
        self.total = torch.zeros(1)

    def forward(self, seen: torch.Tensor):
        self.total = self.total + seen[:, :1]
        return self.total


class Three(torch.nn.Module):
    """Sees three numbers."""

    def __init__(self):
        super().__init__()
        self.layer = torch.nn.Linear(3, 1)

    def forward(self, seen: torch.Tensor):
        return self.layer(seen)
