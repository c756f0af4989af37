"""The report: one HTML file that opens from disk, with the frontier and the failures in 3D."""

from rigid.report.build import build_report
from rigid.report.poses import decode_poses, encode_poses

__all__ = ["build_report", "decode_poses", "encode_poses"]
