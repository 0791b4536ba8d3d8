// Robots used by several tests of the importer.
#pragma once

namespace limber::model::test {

// an upright arm: hinge about z at 1 m, hinge about -y at 2 m, slide along a slanted axis
inline constexpr const char* kArm = R"(<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/>
  <link name="upper"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="lower"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="tip"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><axis xyz="0 -1 0"/>
    <limit lower="0.5" upper="2" effort="3" velocity="4"/></joint>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 1"/><axis xyz="0 0 2"/><limit effort="5" velocity="6"/></joint>
  <joint name="slide" type="prismatic"><parent link="lower"/><child link="tip"/>
    <origin xyz="1 0 0"/><axis xyz="1 1 0"/><limit lower="-0.1" upper="0.2" effort="7" velocity="8"/>
    <dynamics damping="0.3" friction="0.4"/></joint>
</robot>)";

// a plate of 1 kg and one of 3 kg fixed to it at a distance of 0.4 m, rotated by 90 degrees about z
inline constexpr const char* kFixed = R"(<robot name="r"><link name="base"/>
<link name="a"><inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/></inertial>
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
<link name="b"><inertial><origin xyz="0.1 0 0"/><mass value="3"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/></inertial>
  <collision><origin xyz="0.1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
<link name="mark"/>
<joint name="j" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
<joint name="weld" type="fixed"><parent link="a"/><child link="b"/><origin xyz="0.4 0 0" rpy="0 0 1.5707963267948966"/></joint>
<joint name="mark_weld" type="fixed"><parent link="b"/><child link="mark"/><origin xyz="0 0 1"/></joint></robot>)";

}  // namespace limber::model::test
