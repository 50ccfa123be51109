from collections.abc import Hashable, Sequence
from typing import Any, Literal, Protocol, overload

import numpy as np
import numpy.typing as npt

from ._core import Body

_Floats = npt.NDArray[np.float64]

class _Mesh(Protocol):
    @property
    def vertices(self) -> Any: ...
    @property
    def faces(self) -> Any: ...

class ContactData:
    names: set[Any]
    def __init__(
        self, names: tuple[Any, Any], faces: Sequence[int], point: _Floats, normal: _Floats, depth: float
    ) -> None: ...
    @property
    def normal(self) -> _Floats: ...
    @property
    def point(self) -> _Floats: ...
    @property
    def depth(self) -> float: ...
    def index(self, name: Hashable) -> int: ...

class DistanceData:
    names: set[Any]
    def __init__(
        self, names: tuple[Any, Any], faces: Sequence[int], points: _Floats, distance: float
    ) -> None: ...
    @property
    def distance(self) -> float: ...
    def index(self, name: Hashable) -> int: ...
    def point(self, name: Hashable) -> _Floats: ...

# What is returned beside the answer depends on two flags; where these are no constants the answer is Any.
class CollisionManager:
    def __init__(self) -> None: ...
    def add_object(self, name: Hashable, mesh: _Mesh, transform: npt.ArrayLike | None = None) -> Body: ...
    def remove_object(self, name: Hashable) -> None: ...
    def set_transform(self, name: Hashable, transform: npt.ArrayLike) -> None: ...
    @overload
    def in_collision_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        return_names: Literal[False] = False,
        return_data: Literal[False] = False,
    ) -> bool: ...
    @overload
    def in_collision_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        *,
        return_names: Literal[True],
        return_data: Literal[False] = False,
    ) -> tuple[bool, set[Any]]: ...
    @overload
    def in_collision_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        return_names: Literal[False] = False,
        *,
        return_data: Literal[True],
    ) -> tuple[bool, list[ContactData]]: ...
    @overload
    def in_collision_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        *,
        return_names: Literal[True],
        return_data: Literal[True],
    ) -> tuple[bool, set[Any], list[ContactData]]: ...
    @overload
    def in_collision_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        return_names: bool = False,
        return_data: bool = False,
    ) -> Any: ...
    @overload
    def in_collision_internal(
        self,
        return_names: Literal[False] = False,
        return_data: Literal[False] = False,
    ) -> bool: ...
    @overload
    def in_collision_internal(
        self,
        return_names: Literal[True],
        return_data: Literal[False] = False,
    ) -> tuple[bool, set[tuple[Any, Any]]]: ...
    @overload
    def in_collision_internal(
        self,
        return_names: Literal[False] = False,
        *,
        return_data: Literal[True],
    ) -> tuple[bool, list[ContactData]]: ...
    @overload
    def in_collision_internal(
        self,
        return_names: Literal[True],
        return_data: Literal[True],
    ) -> tuple[bool, set[tuple[Any, Any]], list[ContactData]]: ...
    @overload
    def in_collision_internal(
        self,
        return_names: bool = False,
        return_data: bool = False,
    ) -> Any: ...
    @overload
    def in_collision_other(
        self,
        other_manager: CollisionManager,
        return_names: Literal[False] = False,
        return_data: Literal[False] = False,
    ) -> bool: ...
    @overload
    def in_collision_other(
        self,
        other_manager: CollisionManager,
        return_names: Literal[True],
        return_data: Literal[False] = False,
    ) -> tuple[bool, set[tuple[Any, Any]]]: ...
    @overload
    def in_collision_other(
        self,
        other_manager: CollisionManager,
        return_names: Literal[False] = False,
        *,
        return_data: Literal[True],
    ) -> tuple[bool, list[ContactData]]: ...
    @overload
    def in_collision_other(
        self,
        other_manager: CollisionManager,
        return_names: Literal[True],
        return_data: Literal[True],
    ) -> tuple[bool, set[tuple[Any, Any]], list[ContactData]]: ...
    @overload
    def in_collision_other(
        self,
        other_manager: CollisionManager,
        return_names: bool = False,
        return_data: bool = False,
    ) -> Any: ...
    @overload
    def min_distance_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        return_name: Literal[False] = False,
        return_data: Literal[False] = False,
    ) -> float: ...
    @overload
    def min_distance_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        *,
        return_name: Literal[True],
        return_data: Literal[False] = False,
    ) -> tuple[float, Any]: ...
    @overload
    def min_distance_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        return_name: Literal[False] = False,
        *,
        return_data: Literal[True],
    ) -> tuple[float, DistanceData | None]: ...
    @overload
    def min_distance_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        *,
        return_name: Literal[True],
        return_data: Literal[True],
    ) -> tuple[float, Any, DistanceData | None]: ...
    @overload
    def min_distance_single(
        self,
        mesh: _Mesh,
        transform: npt.ArrayLike | None = None,
        return_name: bool = False,
        return_data: bool = False,
    ) -> Any: ...
    @overload
    def min_distance_internal(
        self,
        return_names: Literal[False] = False,
        return_data: Literal[False] = False,
    ) -> float: ...
    @overload
    def min_distance_internal(
        self,
        return_names: Literal[True],
        return_data: Literal[False] = False,
    ) -> tuple[float, tuple[Any, Any]]: ...
    @overload
    def min_distance_internal(
        self,
        return_names: Literal[False] = False,
        *,
        return_data: Literal[True],
    ) -> tuple[float, DistanceData | None]: ...
    @overload
    def min_distance_internal(
        self,
        return_names: Literal[True],
        return_data: Literal[True],
    ) -> tuple[float, tuple[Any, Any], DistanceData | None]: ...
    @overload
    def min_distance_internal(
        self,
        return_names: bool = False,
        return_data: bool = False,
    ) -> Any: ...
    @overload
    def min_distance_other(
        self,
        other_manager: CollisionManager,
        return_names: Literal[False] = False,
        return_data: Literal[False] = False,
    ) -> float: ...
    @overload
    def min_distance_other(
        self,
        other_manager: CollisionManager,
        return_names: Literal[True],
        return_data: Literal[False] = False,
    ) -> tuple[float, tuple[Any, Any]]: ...
    @overload
    def min_distance_other(
        self,
        other_manager: CollisionManager,
        return_names: Literal[False] = False,
        *,
        return_data: Literal[True],
    ) -> tuple[float, DistanceData | None]: ...
    @overload
    def min_distance_other(
        self,
        other_manager: CollisionManager,
        return_names: Literal[True],
        return_data: Literal[True],
    ) -> tuple[float, tuple[Any, Any], DistanceData | None]: ...
    @overload
    def min_distance_other(
        self,
        other_manager: CollisionManager,
        return_names: bool = False,
        return_data: bool = False,
    ) -> Any: ...

def scene_to_collision(scene: Any) -> tuple[CollisionManager, dict[Any, Body]]: ...
